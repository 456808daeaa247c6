#pragma once
/// Interface of sources of pressure on the skin, such as smoke.

#include <span>
#include <string_view>

#include "prostm/core/geometry.hpp"

namespace prostm {

class PressureSource {
 public:
  virtual ~PressureSource() = default;
  /// Computes the pressure at points on the skin of one hand [Pa]; targets clamp values below 0.
  /// @param p_D the points.  @param outside unit vector from that skin to the array's side.
  /// @param out one value per point.
  virtual void sample(std::span<const Vec3> p_D, const Vec3& outside,
                      std::span<double> out) const noexcept = 0;
};

/// A named part of a pressure.
struct NamedPressure {
  std::string_view name;
  const PressureSource* source;  ///< not null
};

}  // namespace prostm
