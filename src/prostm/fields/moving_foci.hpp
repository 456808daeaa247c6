#pragma once
/// Generated focal points that move similarly to those of a plan.

#include <cstdint>
#include <vector>

#include "prostm/core/geometry.hpp"

namespace prostm::fields {

/// Focal points on flat ellipses of at most 140 mm, 180 to 220 mm above the array, each at 7 m/s or
/// less in either direction, with acoustic amplitudes that change smoothly between 0.3 and 1.
class MovingFoci {
 public:
  /// @param apart least distance of the ellipses' centres [m]; all must fit within 50 mm of the
  /// array's centre.
  MovingFoci(std::uint64_t seed, int count, double apart);

  int count() const { return static_cast<int>(paths_.size()); }
  Vec3 position(int focus, double time) const;  ///< in D [m]
  double amplitude(int focus, double time) const;

 private:
  struct Path {
    Vec3 centre;
    double start, rate;   ///< phase along the ellipse at time 0 [rad], and its change [rad/s]
    double flatness;      ///< ratio of the axes
    double lobes, shift;  ///< shape of the amplitude around the ellipse
  };
  std::vector<Path> paths_;
};

}  // namespace prostm::fields
