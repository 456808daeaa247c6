#pragma once
/// Search for the closest point of a plan's paths or foci, used for Eq. (1) and coverage.

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <cstdint>

#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

struct ClosestPoint {
  double distance2 = 0.0;   ///< squared [m²]
  std::size_t segment = 0;  ///< index, in the order of paths and points, or of foci
  double along = 0.0;       ///< 0 at the segment's first point, 1 at its second
  double pressure = 0.0;    ///< rendered p_i there, linear between the samples
};

/// All segments of the paths of one patch, in short runs with their bounding boxes; a focus is a
/// segment without length. Allocates nothing.
class PathSegments {
 public:
  static constexpr std::size_t kCapacity = static_cast<std::size_t>(kMaxPaths) * kMaxPathPoints;

  PathSegments(const Plan& plan, int patch);

  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }

  /// Returns the point closest to x over all segments; ties go to the lowest segment. Fastest if
  /// successive x are near each other, because the last closest segment bounds the search.
  /// @pre !empty().
  ClosestPoint closest(const Vec2& x);

  /// Calls visit(cell, closest(its position)) for the cells of the raster's rows from `first` to
  /// `end`, in any order. On rasters much finer than segments it searches tile by tile, among the
  /// segments that can be closest somewhere in the tile.
  template <class Visit>
  void for_closest(const TargetField& raster, int first, int end, Visit&& visit);

 private:
  using Near = boost::container::static_vector<std::uint16_t, kCapacity>;
  static constexpr double kTileEdge = 4e-3;             // [m]
  static constexpr int kLeastTile = 4, kMostTile = 16;  // cells along an edge
  static constexpr std::size_t kRun = 4;                // segments per box

  struct Segment {
    Vec2 start, edge;
    double inverse_length2, pressure, pressure_change;
  };
  struct Box {
    Vec2 low, high;
  };
  void add(const Vec2& a, const Vec2& b, double pressure_a, double pressure_b);
  double project(std::size_t s, const Vec2& x, double& along) const;
  /// Returns all segments that can be closest to a point within `radius` of x, in ascending order.
  Near near(const Vec2& x, double radius) const;
  ClosestPoint closest(const Near& among, const Vec2& x) const;

  std::array<Segment, kCapacity> segments_;
  std::array<Box, kCapacity / kRun> boxes_;
  std::size_t count_ = 0, last_ = 0;
};

template <class Visit>
void PathSegments::for_closest(const TargetField& raster, int first, int end, Visit&& visit) {
  const int tile = std::min(static_cast<int>(kTileEdge / raster.cell), kMostTile);
  if (tile < kLeastTile) {
    for (int row = first; row < end; ++row) {
      for (int col = 0; col < raster.cols; ++col)
        visit(raster.index(row, col), closest(raster.position(row, col)));
    }
    return;
  }
  for (int top = first; top < end; top += tile) {
    for (int left = 0; left < raster.cols; left += tile) {
      const int bottom = std::min(top + tile, end) - 1;
      const int right = std::min(left + tile, raster.cols) - 1;
      const Vec2 corner = raster.position(top, left), other = raster.position(bottom, right);
      const Near among = near(0.5 * (corner + other), 0.5 * (other - corner).norm());
      for (int row = top; row <= bottom; ++row) {
        for (int col = left; col <= right; ++col)
          visit(raster.index(row, col), closest(among, raster.position(row, col)));
      }
    }
  }
}

}  // namespace prostm
