#pragma once
/// Width of a focal point on the skin, by the skin's position and tilt.

#include <vector>

#include "prostm/target/target_field.hpp"

namespace prostm {

/// A table of σ in front of an array, (A22), by `height` above its plane, distance `offset` from
/// its axis, and angle `tilt` between the skin's normal and the axis. Each list ascends; all empty:
/// no table.
struct FocusWidths {
  std::vector<double> height, offset, tilt;  ///< [m], [m], [rad]
  std::vector<double> sigma;                 ///< σ of all combinations, tilt fastest [m]

  bool empty() const { return sigma.empty(); }
  /// Interpolates the table linearly; arguments outside its range are clamped to it.
  /// @pre not empty. Allocates nothing.
  double at(double place_height, double place_offset, double place_tilt) const noexcept;
  /// Returns σ for a target: at the centre of pressure on the skin, with the tilt of its plane;
  /// without pressure, at the plane's origin. @pre not empty. Allocates nothing.
  double on(const TargetField& target) const noexcept;
  bool operator==(const FocusWidths&) const = default;
};

/// Checks a table.
/// @throws std::invalid_argument for lists that do not ascend, some but not all lists empty, sizes
/// that do not agree, a number that is not finite or a σ not in 0.1 to 100 mm.
void validate(const FocusWidths& widths);

}  // namespace prostm
