#include "felt/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::bench {
namespace {

constexpr int kCells = 54;       // per edge of the raster …
constexpr double kCell = 3e-3;   // … of cells [m]
constexpr double kPlan = 0.040;  // time between plans [s]
constexpr std::size_t kPlans = 25;

/// Returns the fractional row and column of a point, or nothing outside the centres of the cells.
bool cell_at(const TargetField& field, const Vec2& x, double& row, double& col) {
  col = (x.x() - field.origin.x()) / field.cell;
  row = (x.y() - field.origin.y()) / field.cell;
  return col >= 0.0 && row >= 0.0 && col < field.cols - 1 && row < field.rows - 1;
}

/// Returns a raster in the plane of `first`, with its skin and its heights.
TargetField raster_over(const TargetField& first) {
  TargetField out;
  out.resize(kCells, kCells);
  out.cell = kCell;
  const Vec2 middle = first.origin + 0.5 * first.cell * Vec2(first.cols - 1, first.rows - 1);
  out.origin = middle - 0.5 * kCell * Vec2(kCells - 1, kCells - 1);
  out.X_DP = first.X_DP;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Vec2 x = out.position(i);
    double row = 0.0, col = 0.0;
    if (!cell_at(first, x, row, col)) continue;
    const auto nearest =
        first.index(static_cast<int>(std::lround(row)), static_cast<int>(std::lround(col)));
    out.skin[i] = first.skin[nearest];
    out.height[i] = height_at(first, x);
  }
  fill_heights(out);
  return out;
}

/// Sets the pressure of `onto` to that of `from`, bilinear between the centres of its cells.
void resample(const TargetField& from, TargetField& onto) {
  for (std::size_t i = 0; i < onto.size(); ++i) {
    onto.pressure[i] = 0.0;
    double row = 0.0, col = 0.0;
    if (onto.skin[i] == 0 || !cell_at(from, onto.position(i), row, col)) continue;
    const int r = static_cast<int>(row), c = static_cast<int>(col);
    const double v = row - r, u = col - c;
    onto.pressure[i] = (1.0 - v) * ((1.0 - u) * from.pressure[from.index(r, c)] +
                                    u * from.pressure[from.index(r, c + 1)]) +
                       v * ((1.0 - u) * from.pressure[from.index(r + 1, c)] +
                            u * from.pressure[from.index(r + 1, c + 1)]);
  }
}

/// Returns the second that begins at frame `first`; empty if a frame of it has no pressure, or if
/// the recording ends.
LiveSequence second_from(const RecordingReader& recording, int first) {
  LiveSequence out;
  const std::span<const double> times = recording.times();
  const double begin = times[static_cast<std::size_t>(first)];
  out.name = fmt::format("from {:.2f} s", begin);
  TargetField raster;
  for (int f = first; f < recording.frames() && out.targets.size() < kPlans; ++f) {
    const TargetFrame frame = recording.frame(f);
    if (frame.patches.empty()) return {};
    const double due = begin + kPlan * static_cast<double>(out.targets.size());
    if (times[static_cast<std::size_t>(f)] < due - 0.25 * kPlan) continue;
    if (out.targets.empty()) raster = raster_over(frame.patches[0]);
    resample(frame.patches[0], raster);
    if (!(max_pressure(raster) > 0.0)) return {};
    out.targets.push_back(raster);
  }
  return out.targets.size() == kPlans ? out : LiveSequence();
}

}  // namespace

std::vector<LiveSequence> recorded_sequences(const std::string& path, int most) {
  const RecordingReader recording(path);
  std::vector<LiveSequence> all;
  for (int f = 0; f < recording.frames();) {
    LiveSequence one = second_from(recording, f);
    const bool found = !one.targets.empty();
    const double end = recording.times()[static_cast<std::size_t>(f)] + kPlan * kPlans;
    if (found) all.push_back(std::move(one));
    for (++f; found && f < recording.frames();) {
      if (recording.times()[static_cast<std::size_t>(f)] >= end) break;
      ++f;
    }
  }
  if (all.empty())
    throw InputError(fmt::format("{}: no second has pressure on a hand in every frame", path));
  const auto size = all.size(), wanted = std::min(size, static_cast<std::size_t>(most));
  std::vector<LiveSequence> some;
  for (std::size_t i = 0; i < wanted; ++i)
    some.push_back(std::move(all[(2 * i + 1) * size / (2 * wanted)]));
  return some;
}

}  // namespace prostm::bench
