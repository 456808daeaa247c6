#pragma once
/// Row kernels of the pressure solvers, in two versions: scalar (the reference) and vector.

#include "prostm/fluid/detail/pressure/pressure_level.hpp"

namespace prostm::fluid {

/// Each works on planes [k0, k1) of the grid it writes. Cells without an equation keep p = 0, and
/// so do halos.
struct PressureKernels {
  /// out = (1 − ω) p + ω D⁻¹ (b + Σ a_f p_f): one weighted Jacobi sweep (F8). out must not be p.
  void (*smooth)(const PressureLevel& level, const float* p, const float* b, float omega,
                 float* out, int k0, int k1);
  /// out = ω D⁻¹ b: the same from p = 0.
  void (*smooth_zero)(const PressureLevel& level, const float* b, float omega, float* out, int k0,
                      int k1);
  /// out = A p.
  void (*apply)(const PressureLevel& level, const float* p, float* out, int k0, int k1);
  /// coarse_b = half the sum of b − A p over the 8 children (F9). Planes of the coarse grid.
  void (*restrict_residual)(const PressureLevel& fine, const float* p, const float* b,
                            const PressureLevel& coarse, float* coarse_b, int k0, int k1);
  /// p += trilinear interpolation of e (F10). The floor mirrors e, the open sides have e = 0.
  /// Planes of the fine grid.
  void (*prolong_add)(const PressureLevel& coarse, const float* e, const PressureLevel& fine,
                      float* p, int k0, int k1);
};

const PressureKernels& scalar_pressure_kernels();
/// Returns the vector kernels for this processor, or the scalar ones if Highway has only its
/// one-lane fallback.
const PressureKernels& fast_pressure_kernels();

}  // namespace prostm::fluid
