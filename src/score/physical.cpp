#include "score/physical.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "target/skin_normal.hpp"

namespace prostm {
namespace {

constexpr int kSamplesLookedAt = 64;
constexpr double kLoudEnough = 0.1;  // intensity of a focal point that is looked at
constexpr int kSide = 13;            // points along each edge of the grid around a focal point
constexpr double kStep = 0.75e-3;    // between them [m]

/// Acoustic pressure squared on the grid around a focal point, row by row along y.
std::array<double, static_cast<std::size_t>(kSide* kSide)> around(const PackedArray& packed,
                                                                  const Vec3& focus,
                                                                  const Pose& X_DP,
                                                                  const Eigen::VectorXcf& output) {
  std::vector<Vec3> points;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double half = 0.5 * (kSide - 1);
      points.push_back(focus + X_DP.linear() * Vec3(kStep * (i - half), kStep * (j - half), 0.0));
    }
  }
  const Eigen::VectorXcf p = acoustic_pressure(packed, points, output);
  std::array<double, static_cast<std::size_t>(kSide * kSide)> out{};
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = static_cast<double>(std::norm(p[static_cast<Eigen::Index>(i)]));
  }
  return out;
}

/// Where a parabola through three values a step apart is highest, from the middle, in steps.
double peak(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// How far the highest place is from the grid's middle [m].
double offset_of(const std::array<double, static_cast<std::size_t>(kSide* kSide)>& square) {
  const auto at = static_cast<int>(std::max_element(square.begin(), square.end()) - square.begin());
  const int col = at % kSide, row = at / kSide;
  const auto value = [&](int j, int i) { return square[static_cast<std::size_t>(j * kSide + i)]; };
  double x = col, y = row;
  if (col > 0 && col + 1 < kSide) {
    x += peak(value(row, col - 1), value(row, col), value(row, col + 1));
  }
  if (row > 0 && row + 1 < kSide) {
    y += peak(value(row - 1, col), value(row, col), value(row + 1, col));
  }
  const double half = 0.5 * (kSide - 1);
  return kStep * std::hypot(x - half, y - half);
}

/// Largest value of the envelope on skin beside all paths.
double largest_beside(const SkinSurface& skin, const LoopSamples& loop,
                      const std::vector<float>& envelope) {
  std::vector<Eigen::Vector3f> places;
  constexpr std::size_t kEvery = 4;  // samples: 0.7 mm of a path
  for (std::size_t i = 0; i < loop.sample.size(); ++i) {
    const std::size_t sample = i / static_cast<std::size_t>(loop.foci);
    if (sample % kEvery == 0 && loop.sample[i].intensity > 0.0F) {
      places.push_back(loop.sample[i].p_D);
    }
  }
  constexpr float kSquare = static_cast<float>(kBesidePaths * kBesidePaths);
  float most = 0.0F;
  for (std::size_t m = 0; m < skin.cell.size(); ++m) {
    if (envelope[m] <= most) continue;
    const Eigen::Vector3f p = skin.points.p_D[m].cast<float>();
    const bool beside = std::none_of(
        places.begin(), places.end(),
        [&](const Eigen::Vector3f& place) { return (p - place).squaredNorm() < kSquare; });
    if (beside) most = envelope[m];
  }
  return static_cast<double>(most);
}

}  // namespace

SkinSurface skin_surface(const TargetField& raster) {
  SkinSurface skin;
  for (int row = 0; row < raster.rows; ++row) {
    for (int col = 0; col < raster.cols; ++col) {
      const std::size_t cell = raster.index(row, col);
      if (raster.skin[cell] == 0) continue;
      const Vec2 x = raster.position(row, col);
      skin.cell.push_back(cell);
      skin.points.p_D.push_back(raster.X_DP * Vec3(x.x(), x.y(), raster.height[cell]));
      skin.points.normal.push_back(raster.X_DP.linear() * skin_normal(raster, row, col));
    }
  }
  return skin;
}

FocusAccuracy focus_accuracy(const PackedArray& packed, const LoopSamples& loop,
                             const LoopDriveResult& drives, const Pose& X_DP) {
  FocusAccuracy out;
  out.least_level = std::numeric_limits<double>::max();
  const int every = std::max(1, loop.samples / kSamplesLookedAt);
  for (int k = 0; k < loop.samples; k += every) {
    const Eigen::VectorXcf output = drives.output.col(k);
    for (int f = 0; f < loop.foci; ++f) {
      const FocusSample& focus = loop.sample[static_cast<std::size_t>(k * loop.foci + f)];
      const double intensity = static_cast<double>(focus.intensity);
      if (intensity <= kLoudEnough) continue;
      const auto square = around(packed, focus.p_D.cast<double>(), X_DP, output);
      const double offset = offset_of(square);
      const double level =
          std::sqrt(square[square.size() / 2]) / (intensity * drives.full_scale_pa);
      ++out.looked_at;
      out.mean_offset += offset;
      out.worst_offset = std::max(out.worst_offset, offset);
      out.mean_level += level;
      out.least_level = std::min(out.least_level, level);
      out.most_level = std::max(out.most_level, level);
    }
  }
  if (out.looked_at == 0) return {};
  out.mean_offset /= out.looked_at;
  out.mean_level /= out.looked_at;
  return out;
}

PhysicalField physical_field(const PackedArray& packed, const Medium& medium,
                             const TargetField& raster, const LoopSamples& loop,
                             const LoopDriveResult& drives, WorkerPool& pool) {
  const SkinSurface skin = skin_surface(raster);
  if (skin.cell.empty()) {
    throw std::invalid_argument("the raster has no skin; there must be a cell with a height");
  }
  const LoopPressure pressure = loop_pressure(packed, medium, drives.output, skin.points, 0, pool);
  PhysicalField out;
  out.mean.assign(raster.size(), 0.0);
  out.envelope.assign(raster.size(), 0.0);
  for (std::size_t m = 0; m < skin.cell.size(); ++m) {
    out.mean[skin.cell[m]] = static_cast<double>(pressure.mean[m]);
    out.envelope[skin.cell[m]] = static_cast<double>(pressure.envelope[m]);
  }
  out.largest = *std::max_element(out.envelope.begin(), out.envelope.end());
  out.largest_mean = *std::max_element(out.mean.begin(), out.mean.end());
  if (out.largest > 0.0) {
    out.side_lobe = largest_beside(skin, loop, pressure.envelope) / out.largest;
  }
  return out;
}

Metrics score_physical(const TargetField& target, const std::vector<double>& field,
                       double coverage) {
  double with_target = 0.0, with_itself = 0.0;
  for (std::size_t c = 0; c < target.size(); ++c) {
    if (target.skin[c] == 0) continue;
    with_target += target.pressure[c] * field[c];
    with_itself += field[c] * field[c];
  }
  if (with_itself <= 0.0) return {};
  std::vector<double> scaled(field);
  for (double& p : scaled) p *= with_target / with_itself;
  return score_field(target, scaled, coverage);
}

}  // namespace prostm
