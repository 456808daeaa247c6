#include "prostm/score/physical.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "prostm/acoustics/field/flat_field.hpp"
#include "prostm/acoustics/field/focus_width.hpp"
#include "prostm/target/skin_normal.hpp"

namespace prostm {
namespace {

constexpr int kSamplesLookedAt = 64;
constexpr double kLeastIntensity = 0.1;  // only focal points above this intensity are measured
constexpr int kSide = 13;                // points along each edge of the grid around a focal point
constexpr double kStep = 0.75e-3;        // distance between them [m]

/// Returns the acoustic pressure squared on the grid around a focal point, row by row along y.
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

/// Position of the maximum of a parabola through three values one step apart, relative to the
/// middle one, in steps.
double peak(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

/// Returns the distance of the highest point from the grid's centre [m].
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

/// Returns the positions of a loop's non-silent focal points, every 0.7 mm of a path.
std::vector<Eigen::Vector3f> places_of(const LoopSamples& loop) {
  constexpr std::size_t kEvery = 4;  // samples
  std::vector<Eigen::Vector3f> places;
  for (std::size_t i = 0; i < loop.sample.size(); ++i) {
    const std::size_t sample = i / static_cast<std::size_t>(loop.foci);
    if (sample % kEvery == 0 && loop.sample[i].intensity > 0.0F) {
      places.push_back(loop.sample[i].p_D);
    }
  }
  return places;
}

/// Whether all skin has one height.
bool is_flat(const TargetField& raster) {
  const auto first = std::ranges::find(raster.skin, 1) - raster.skin.begin();
  const double height = raster.height[static_cast<std::size_t>(first)];
  for (std::size_t c = 0; c < raster.size(); ++c) {
    if (raster.skin[c] != 0 && raster.height[c] != height) return false;
  }
  return true;
}

/// Computes a PhysicalField. Cells may be wider than a lobe, so the largest values are searched on
/// points at most 2 mm apart, and then on points 0.5 mm apart around the highest of these.
class FieldMeter {
 public:
  FieldMeter(const PackedArray& packed, const Medium& medium, const TargetField& raster,
             const SkinSurface& skin, const LoopSamples& loop, const LoopDriveResult& drives,
             int parts_of_loop, WorkerPool& pool)
      : packed_(packed),
        medium_(medium),
        raster_(raster),
        skin_(skin),
        places_(places_of(loop)),
        basis_(packed, drives.output, pool),
        pool_(pool) {
    field.mean.assign(raster.size(), 0.0);
    field.envelope.assign(raster.size(), 0.0);
    field.parts = parts_of_loop;
    field.part.assign(raster.size() * static_cast<std::size_t>(parts_of_loop), 0.0);
    // an odd number along each edge, so that one point is in the middle
    const int parts =
        1 + 2 * std::max(0, static_cast<int>(std::ceil(raster.cell / kLook / 2 - 0.5)));
    std::vector<Place> all, near;
    for (std::size_t m = 0; m < skin.cell.size(); ++m) {
      divide({m, raster.position(skin.cell[m])}, raster.cell, parts, all);
    }
    const std::vector<Vec3> places = on_skin(all);
    const LoopPressure found = parts == 1 && is_flat(raster)
                                   ? flat_pressure(parts_of_loop)
                                   : pressure_at(all, places, parts_of_loop);
    look(all, places, found);
    const auto of_a_cell = static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts);
    const auto frames = static_cast<std::size_t>(parts_of_loop);
    for (std::size_t m = 0; m < skin.cell.size(); ++m) {
      const std::size_t middle = m * of_a_cell + of_a_cell / 2, cell = skin.cell[m];
      field.mean[cell] = static_cast<double>(found.mean[middle]);
      field.envelope[cell] = static_cast<double>(found.envelope[middle]);
      for (std::size_t k = 0; k < frames; ++k) {
        field.part[k * raster.size() + cell] =
            static_cast<double>(found.frame[middle * frames + k]);
      }
    }
    // the surroundings of a point may be beside the paths even if the point itself is not
    for (const Place& place : std::exchange(highest_, {})) {
      divide(place, 2.0 * kLook, 2 * kFiner, near);
    }
    std::erase_if(near, [&](const Place& place) { return !has_skin(place.x); });
    const std::vector<Vec3> places_near = on_skin(near);
    look(near, places_near, pressure_at(near, places_near, 0));
    if (field.largest > 0.0) field.side_lobe = beside_ / field.largest;
  }

  PhysicalField field;

 private:
  struct Place {
    std::size_t of;  // index in skin.cell of the cell that provides the normal
    Vec2 x;          // in P
  };
  static constexpr double kLook = 2e-3;  // [m]
  static constexpr int kFiner = 4;
  static constexpr std::size_t kHighest = 32;  // points of each kind that are refined
  static constexpr double kApart = kLook;      // least distance between them [m]

  static void divide(const Place& middle, double edge, int parts, std::vector<Place>& out) {
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i < parts; ++i) {
        const Vec2 share((i + 0.5) / parts - 0.5, (j + 0.5) / parts - 0.5);
        out.push_back({middle.of, middle.x + edge * share});
      }
    }
  }

  bool has_skin(const Vec2& x) const {
    const Vec2 q = (x - raster_.origin) / raster_.cell;
    const long row = std::lround(q.y()), col = std::lround(q.x());
    return row >= 0 && col >= 0 && row < raster_.rows && col < raster_.cols &&
           raster_.skin[raster_.index(static_cast<int>(row), static_cast<int>(col))] != 0;
  }

  bool beside_paths(const Vec3& p_D) const {
    constexpr float kSquare = static_cast<float>(kBesidePaths * kBesidePaths);
    const Eigen::Vector3f p = p_D.cast<float>();
    return std::none_of(places_.begin(), places_.end(), [&](const Eigen::Vector3f& place) {
      return (p - place).squaredNorm() < kSquare;
    });
  }

  std::vector<Vec3> on_skin(const std::vector<Place>& at) const {
    std::vector<Vec3> out;
    for (const Place& place : at) {
      const double height = height_at(raster_, place.x);
      out.push_back(raster_.X_DP * Vec3(place.x.x(), place.x.y(), height));
    }
    return out;
  }

  LoopPressure pressure_at(const std::vector<Place>& at, const std::vector<Vec3>& p_D, int frames) {
    SurfacePoints points{p_D, {}};
    for (const Place& place : at) points.normal.push_back(skin_.points.normal[place.of]);
    return loop_pressure(packed_, medium_, basis_, points, frames, pool_);
  }

  /// Returns the pressure at the centres of all cells with skin. @pre is_flat(raster_)
  LoopPressure flat_pressure(int frames) {
    const Eigen::Matrix3d& axes = raster_.X_DP.linear();
    FlatRaster flat;
    const double height = raster_.height[skin_.cell.front()];
    flat.corner = raster_.X_DP * Vec3(raster_.origin.x(), raster_.origin.y(), height);
    flat.right = raster_.cell * axes.col(0);
    flat.down = raster_.cell * axes.col(1);
    flat.normal = skin_.points.normal.front();
    flat.rows = raster_.rows;
    flat.cols = raster_.cols;
    return flat_loop_pressure(packed_, medium_, basis_, flat, skin_.cell, frames, pool_);
  }

  /// Updates the largest values, and adds the highest points of each kind to `highest_`.
  void look(const std::vector<Place>& at, const std::vector<Vec3>& p_D, const LoopPressure& found) {
    const auto take = [&](const std::vector<float>& value, auto&& counts, double& largest) {
      std::vector<std::size_t> order(at.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return value[a] > value[b]; });
      // with a least distance, so that they belong to different lobes
      const std::size_t before = highest_.size();
      for (std::size_t i = 0; i < order.size() && highest_.size() < before + kHighest; ++i) {
        const Place& place = at[order[i]];
        if (!counts(order[i])) continue;
        largest = std::max(largest, static_cast<double>(value[order[i]]));
        const bool apart =
            std::none_of(highest_.begin() + static_cast<std::ptrdiff_t>(before), highest_.end(),
                         [&](const Place& other) { return (other.x - place.x).norm() < kApart; });
        if (apart) highest_.push_back(place);
      }
    };
    const auto anywhere = [](std::size_t) { return true; };
    take(found.envelope, anywhere, field.largest);
    take(found.mean, anywhere, field.largest_mean);
    take(
        found.envelope, [&](std::size_t i) { return beside_paths(p_D[i]); }, beside_);
  }

  const PackedArray& packed_;
  const Medium& medium_;
  const TargetField& raster_;
  const SkinSurface& skin_;
  std::vector<Eigen::Vector3f> places_;
  LoopBasis basis_;
  WorkerPool& pool_;
  std::vector<Place> highest_;
  double beside_ = 0.0;  // largest value of the envelope beside the paths
};

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

double sigma_on_skin(const TransducerArray& array, const TargetField& target, double otherwise) {
  const SkinSurface skin = skin_surface(target);
  Vec3 middle = Vec3::Zero(), normal = Vec3::Zero();
  double sum = 0.0;
  for (std::size_t i = 0; i < skin.cell.size(); ++i) {
    const double p = target.pressure[skin.cell[i]];
    middle += p * skin.points.p_D[i];
    normal += p * skin.points.normal[i];
    sum += p;
  }
  if (sum <= 0.0 || normal.norm() < 1e-3 * sum) return otherwise;
  normal.normalize();
  const Medium air;
  const PackedArray packed(array, air);
  return focus_width(packed, air, middle / sum, normal, normal.unitOrthogonal()).sigma();
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
      if (intensity <= kLeastIntensity) continue;
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
                             const LoopDriveResult& drives, int parts, WorkerPool& pool) {
  const SkinSurface skin = skin_surface(raster);
  if (skin.cell.empty()) {
    throw std::invalid_argument("the raster has no skin; at least one cell must have a height");
  }
  return FieldMeter(packed, medium, raster, skin, loop, drives, parts, pool).field;
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
