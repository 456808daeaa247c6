#pragma once
/// Sources of pressure on skin: smoke, or anything else.

#include <span>

#include "prostm/core/geometry.hpp"

namespace prostm {

class PressureSource {
 public:
  virtual ~PressureSource() = default;
  /// Computes the pressure at points on the skin of one hand [Pa]; values below 0 count as 0.
  /// @param p_D the points.  @param outside unit vector from that skin to the array's side.
  /// @param out one value per point.
  virtual void sample(std::span<const Vec3> p_D, const Vec3& outside,
                      std::span<double> out) const noexcept = 0;
};

}  // namespace prostm
