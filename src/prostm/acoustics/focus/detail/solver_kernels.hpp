#pragma once
/// The inner loops of the focus solvers that run at every sample. G has one row for each of M focal
/// points and one column for each transducer; drives are row 0 of their matrix.

#include <complex>
#include <span>

#include "prostm/acoustics/focus/detail/complex_rows.hpp"

namespace prostm::solving {

using Complex = std::complex<float>;

struct Magnitudes {
  float sum = 0.0F, squares = 0.0F;
};
/// Σ_n |G_mn| and Σ_n |G_mn|².
Magnitudes magnitudes(const ComplexRows& g, std::size_t m);

/// q = Gᴴ c. @return the largest |q_n|.
float back_propagate(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive);

/// q = the phases of Gᴴ c, |q_n| = 1; 0 where Gᴴ c is 0.
void back_propagate_phases(const ComplexRows& g, std::span<const Complex> c, ComplexRows& drive);

/// y = G q.
void propagate_drives(const ComplexRows& g, const ComplexRows& drive, std::span<Complex> y);

/// R = G B of (A13), B the naive focus of each focal point; row j of `out` is column j of R.
void correlate(const ComplexRows& g, std::size_t foci, ComplexRows& out);

/// Runs the iterations of (A13) on x, M numbers in row 0; on return x has the magnitudes a.
/// @param a in the real parts of row 0. @param scratch one row of M numbers.
void iterate_gs_pat(const ComplexRows& r, const ComplexRows& a, std::size_t foci, int iterations,
                    ComplexRows& x, ComplexRows& scratch);

/// Writes t_mn = −Im(conj(u_m) G_mn q_n), the derivative of |y_m| with respect to the phase of q_n
/// for u = ŷ, to the real parts of `turns`, and t tᵀ, M × M, to `normal`.
void phase_gradients(const ComplexRows& g, std::span<const Complex> u, const ComplexRows& drive,
                     ComplexRows& turns, std::span<float> normal);

/// Shifts the phases of q, |q_n| = 1, by about δ = Σ_m t_mn x_m: q becomes q (1 + iδ)/|1 + iδ|.
void turn_phases(const ComplexRows& turns, std::span<const float> x, ComplexRows& drive);

}  // namespace prostm::solving
