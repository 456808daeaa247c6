#pragma once
/// Width and strength of a focus on the skin, by its position and the skin's tilt.

#include <span>
#include <vector>

#include "prostm/acoustics/field/propagation_kernels.hpp"

namespace prostm {

/// A single focus on a flat surface: every transducer at full drive and in phase there, (A3).
struct FocusWidth {
  double along = 0.0;   ///< σ of radiation pressure (A20) along a direction of the surface [m]
  double across = 0.0;  ///< σ at a right angle to it [m]
  double level = 0.0;   ///< radiation pressure at the focus [Pa]

  /// σ of a round focus of the same area [m].
  double sigma() const;
};

/// Fits a Gaussian by least squares along both directions, (A22), where the pressure is above a
/// tenth of that at the focus.
/// @param normal unit normal of the surface. @param x unit vector along the surface.
/// @throws std::invalid_argument for a focus that propagation_to() rejects, or a surface that faces
/// away from the whole array.
FocusWidth focus_width(const PackedArray& packed, const Medium& medium, const Vec3& focus,
                       const Vec3& normal, const Vec3& x);

/// A focus at `height` above the array's plane and distance `offset` from its axis along x, on a
/// surface rotated by `tilt` about y so that it faces away from the axis; FocusWidth::along is in
/// that direction.
struct FocusWidthEntry {
  double height = 0.0, offset = 0.0;  ///< [m]
  double tilt = 0.0;                  ///< [rad]
  FocusWidth width;
};
/// Computes the widths of all combinations, tilt fastest. @throws as focus_width() does.
std::vector<FocusWidthEntry> focus_width_table(const PackedArray& packed, const Medium& medium,
                                               std::span<const double> heights,
                                               std::span<const double> offsets,
                                               std::span<const double> tilts);

}  // namespace prostm
