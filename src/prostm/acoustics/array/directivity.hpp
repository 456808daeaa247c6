#pragma once
/// Directivity of a transducer.

namespace prostm {

enum class Directivity {
  Piston,   ///< baffled piston, (A2)
  T4010A1,  ///< data sheet of the Nippon Ceramic T4010A1, as used by AUTD3, (A8)
  Omni,     ///< the same in all directions, including behind the transducer
};

/// Returns the name in files: "piston", "t4010a1", "omni".
const char* directivity_name(Directivity kind);

/// Far-field pressure at the angle θ from the transducer's normal, relative to that on its axis:
/// 0..1 (up to 1.008 where the spline of T4010A1 overshoots). Piston (A2) and T4010A1 (A8) are 0
/// behind the transducer's plane, cos θ < 0.
/// @param ka wave number × radius of the piston; used only by Piston.
/// @param cos_theta may exceed [-1, 1] by rounding errors.
double directivity(Directivity kind, double ka, double cos_theta);

/// (A2): 2 J₁(ka sin θ)/(ka sin θ); 1 on axis. Even in sin θ.
double piston_directivity(double ka, double sin_theta);

}  // namespace prostm
