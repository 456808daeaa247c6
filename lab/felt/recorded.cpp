#include "felt/recorded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/psychophysics/places.hpp"

namespace prostm::bench {
namespace {

constexpr double kCell = 3e-3;   // edge of a cell of a sequence's raster [m]
constexpr double kPlan = 0.040;  // time between plans [s]

/// Returns the middle of a target's raster [m].
Vec2 middle_of(const TargetField& field) {
  return field.origin + 0.5 * field.cell * Vec2(field.cols - 1, field.rows - 1);
}

/// Returns a map of `from`, a value per cell, at the cells of `onto`, bilinear between the centres.
template <class Map>
std::vector<double> resampled(const TargetField& from, const Map& map, const TargetField& onto) {
  const SkinPatch patch{from.rows, from.cols, from.cell};
  const std::vector<double> values(map.begin(), map.end());
  std::vector<double> out;
  for (std::size_t i = 0; i < onto.size(); ++i)
    out.push_back(value_at(patch, values, onto.position(i) - middle_of(from)));
  return out;
}

/// Returns a raster in the plane of `first`, with its skin and its heights.
TargetField raster_over(const TargetField& first) {
  TargetField out;
  out.resize(kLiveCells, kLiveCells);
  out.cell = kCell;
  out.origin = middle_of(first) - 0.5 * kCell * Vec2(kLiveCells - 1, kLiveCells - 1);
  out.X_DP = first.X_DP;
  const std::vector<double> skin = resampled(first, first.skin, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (skin[i] < 0.5) continue;
    out.skin[i] = 1;
    out.height[i] = height_at(first, out.position(i));
  }
  fill_heights(out);
  return out;
}

/// Sets the pressure of `onto`, on its skin, to that of `from`.
void take_pressure(const TargetField& from, TargetField& onto) {
  onto.pressure = resampled(from, from.pressure, onto);
  for (std::size_t i = 0; i < onto.size(); ++i) {
    if (onto.skin[i] == 0) onto.pressure[i] = 0.0;
  }
}

/// Returns the frame that is nearest to a time [s].
int frame_at(std::span<const double> times, double time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return 0;
  const bool is_before = after == times.end() || time - *std::prev(after) < *after - time;
  return static_cast<int>(after - times.begin()) - (is_before ? 1 : 0);
}

/// Returns the targets of the second that begins at frame `first`; empty if there is a frame
/// without a hand or a target without pressure, if no frame is within 20 ms of a plan's time, or if
/// the recording ends.
std::vector<TargetField> second_from(const RecordingReader& recording, int first) {
  const std::span<const double> times = recording.times();
  const auto time_of = [&](int f) { return times[static_cast<std::size_t>(f)]; };
  std::vector<TargetField> out;
  TargetField raster;
  for (int k = 0, f = first; k < kLivePlans; ++k) {
    const double due = time_of(first) + kPlan * k;
    const int wanted = frame_at(times, due);
    if (std::abs(time_of(wanted) - due) > 0.5 * kPlan) return {};
    TargetFrame frame;
    for (; f <= wanted; ++f) {
      frame = recording.frame(f);
      if (frame.patches.empty()) return {};
    }
    if (frame.patches.empty()) return {};  // the frame of the plan before
    if (k == 0) raster = raster_over(frame.patches[0]);
    take_pressure(frame.patches[0], raster);
    if (!(max_pressure(raster) > 0.0)) return {};
    out.push_back(raster);
  }
  return out;
}

}  // namespace

std::vector<LiveSequence> recorded_sequences(const std::string& path, int most) {
  const RecordingReader recording(path);
  const std::span<const double> times = recording.times();
  std::vector<LiveSequence> all;
  for (std::size_t f = 0; f < times.size();) {
    std::vector<TargetField> targets = second_from(recording, static_cast<int>(f));
    if (targets.empty()) {
      ++f;
      continue;
    }
    const double begin = times[f];
    all.push_back({fmt::format("from {:.2f} s", begin), std::move(targets)});
    while (f < times.size() && times[f] < begin + (kLivePlans - 0.5) * kPlan) ++f;
  }
  if (all.empty()) {
    throw InputError(fmt::format(
        "{}: no second has a hand with pressure in every frame, and 25 frames or more", path));
  }
  const std::size_t size = all.size(),
                    wanted = most > 0 ? std::min(size, static_cast<std::size_t>(most)) : size;
  std::vector<LiveSequence> some;
  for (std::size_t i = 0; i < wanted; ++i)
    some.push_back(std::move(all[(2 * i + 1) * size / (2 * wanted)]));
  return some;
}

}  // namespace prostm::bench
