#pragma once
/// The closest point of a plan's paths or foci, the search behind Eq. (1) and coverage.

#include <array>
#include <cstddef>

#include "prostm/plan/plan.hpp"

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

 private:
  static constexpr std::size_t kRun = 4;  // segments per box

  struct Segment {
    Vec2 start, edge;
    double inverse_length2, pressure, pressure_change;
  };
  struct Box {
    Vec2 low, high;
  };
  void add(const Vec2& a, const Vec2& b, double pressure_a, double pressure_b);
  double project(std::size_t s, const Vec2& x, double& along) const;

  std::array<Segment, kCapacity> segments_;
  std::array<Box, kCapacity / kRun> boxes_;
  std::size_t count_ = 0, last_ = 0;
};

}  // namespace prostm
