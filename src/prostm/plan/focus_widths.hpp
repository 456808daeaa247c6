#pragma once
/// Width of a focal point on the skin, by the skin's position and tilt.

#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// A table of σ for places in front of an array, (A22): at `height` above its plane, `offset`
/// beside its axis, on skin turned by `tilt` from facing along the axis. Each list ascends; all
/// empty: no table.
struct FocusWidths {
  std::vector<double> height, offset, tilt;  ///< [m], [m], [rad]
  std::vector<double> sigma;                 ///< σ of all combinations, tilt fastest [m]

  bool empty() const { return sigma.empty(); }
  /// Interpolates linearly between the table's places; beyond them, returns the σ of the nearest
  /// place.
  /// @pre not empty. Allocates nothing.
  double at(double place_height, double place_offset, double place_tilt) const noexcept;
  /// Returns σ for a target: at the middle of its pressure on the skin, with the tilt of its plane;
  /// without pressure, at the plane's origin. @pre not empty. Allocates nothing.
  double on(const TargetField& target) const noexcept;
  bool operator==(const FocusWidths&) const = default;
};

/// Checks a table.
/// @throws std::invalid_argument for lists that do not ascend or are empty beside others, sizes
/// that do not agree, a number that is not finite or a σ not in 0.1 to 100 mm.
void validate(const FocusWidths& widths);

}  // namespace prostm
