#pragma once
/// Pressures relative to the maximum, as planners use them in decisions.

namespace prostm {

/// Returns a pressure over the field's largest, rounded to 24 bits, so that plans do not depend on
/// the unit: the last bits of the quotient change with the unit, and cells of a raster are often
/// equal up to these bits. @pre maximum > 0.
inline double pressure_share(double pressure, double maximum) {
  return static_cast<double>(static_cast<float>(pressure / maximum));
}

}  // namespace prostm
