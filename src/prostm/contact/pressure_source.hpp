#pragma once
/// What presses on skin: smoke, or anything else.

#include <span>

#include "prostm/core/geometry.hpp"

namespace prostm {

class PressureSource {
 public:
  virtual ~PressureSource() = default;
  /// The pressure on points of the skin of one hand [Pa]; below 0 counts as none.
  /// @param p_D the points.  @param outside unit vector from that skin to the array's side.
  /// @param out as many values.
  virtual void sample(std::span<const Vec3> p_D, const Vec3& outside,
                      std::span<double> out) const noexcept = 0;
};

}  // namespace prostm
