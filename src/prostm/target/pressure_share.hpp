#pragma once
/// Pressures in the form that planners base decisions on.

namespace prostm {

/// Returns a pressure over the field's largest, rounded to 24 bits, so that a field gives the same
/// plan in any unit: the last bits of the quotient change with the unit, and cells of a raster
/// often tie to within them. @pre maximum > 0.
inline double pressure_share(double pressure, double maximum) {
  return static_cast<double>(static_cast<float>(pressure / maximum));
}

}  // namespace prostm
