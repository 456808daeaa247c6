#pragma once
/// Focus solvers that run at every sample of a stream.

#include <Eigen/Geometry>
#include <array>
#include <complex>
#include <span>

#include "prostm/acoustics/field/propagation_kernels.hpp"
#include "prostm/acoustics/focus/detail/complex_rows.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"

namespace prostm {

inline constexpr std::size_t kMaxLiveFoci = 32;

struct LiveFocusSettings {
  FocusMethod method = FocusMethod::Weighted;  ///< Weighted, Superposition or GsPat
  /// Iterations per sample; use 20 for GsPat, which gains little from the previous sample. With
  /// `adds_phasors` there are up to two more while the error of a share exceeds 5 %.
  int iterations = 1;
  /// Number of phase levels per turn to which the drives, or c with `adds_phasors`, are rounded; 0:
  /// no rounding.
  int phase_levels = 0;
  bool warm = true;  ///< whether a sample begins with the previous phases and weights
  /// Acoustic pressure (rms) at amplitude 1 [Pa], the same everywhere; 0: the pressure of a single
  /// focal point of the whole array at that position.
  double full_scale = 0.0;
  /// Where a single focal point reaches less than full_scale, its share of full_scale is taken to
  /// be at least 1/bound, so that a far focal point does not use up the output for nearer ones.
  double bound = 2.0;
  /// For arrays that compute their own drives, as the phases of Σ_m c_m e^{−ik r_mn}: Weighted,
  /// with c as the only variables, (A23). See coefficient().
  bool adds_phasors = false;
  /// With `adds_phasors`, the share of the transducers' output that remains after a sample,
  /// e^{−T/τ} of (A10) at resonance, 0..0.95; 0: no memory. The shares reached are then those at
  /// the end of a sample, if play() is called after each solve().
  double memory = 0.0;
};

/// A focal point in one sample.
struct LiveFocus {
  Eigen::Vector3f p_D = Eigen::Vector3f::Zero();  ///< [m]
  /// Wanted acoustic pressure relative to full_scale, or to that of a single focal point there,
  /// 0..1.
  float amplitude = 0.0F;
};

/// Finds the drives for one sample after another, in single precision with vector kernels. As in
/// solve_foci, amplitudes beyond the array's output are scaled by a common factor, and no |q|
/// exceeds 1. A focal point is identified by its index in the list: its phase and weight are kept
/// from sample to sample, so that the drives change smoothly when it moves.
class LiveFocusSolver {
 public:
  /// @throws std::invalid_argument for an array that is not valid, a method that does not run live,
  /// iterations not in 1 to 1000, phase_levels neither 0 nor 2 to 65536, full_scale not in 0 to 1e6
  /// Pa, bound not in 1 to 100.
  LiveFocusSolver(const TransducerArray& array, const Medium& medium,
                  const LiveFocusSettings& settings);

  /// Finds the drives for these focal points. Ignores silent ones, with an amplitude up to 1e-4,
  /// and invalid ones: with a position or an amplitude that is out of range or not finite, behind
  /// the array, nearer than kNearestPoint to a transducer, or with an index from kMaxLiveFoci on.
  /// Allocates and throws nothing.
  void solve(std::span<const LiveFocus> foci) noexcept;

  /// q in row 0, a column for each transducer.
  const ComplexRows& drive() const { return drive_; }
  /// Reached share of the amplitudes as a whole, Σ a |y| / Σ a², where y and a are relative to the
  /// pressure of each focal point alone; at most 1, and 0 without focal points. Computed before
  /// phases are rounded.
  float level() const { return level_; }
  /// With `adds_phasors`, c of a focal point in the last sample, by its index in the list: 0 for
  /// ignored focal points; the largest |c| is 1.
  std::complex<float> coefficient(std::size_t focus) const { return coefficient_[focus]; }
  /// With `adds_phasors`, the magnitude of all drives of the last sample, ≤ 1; 0 without focal
  /// points.
  float magnitude() const { return magnitude_of_drives_; }

  /// With `adds_phasors` and `memory`, updates the transducers' outputs by the drives of the last
  /// solve(). @param turn common phase factor of all drives relative to the previous sample,
  /// |turn| = 1. The next solve() assumes a turn of 1.
  void play(std::complex<float> turn) noexcept;

  /// Discards the state of the previous sample.
  void reset();

 private:
  using Complex = std::complex<float>;

  void add(const LiveFocus& focus, std::size_t place);
  void set_phasors();
  float superpose();
  float gs_pat();
  float weighted();
  float add_phasors();
  void correct_phasors();
  void set_phasor_gradients();
  float largest_error() const;
  void recall();
  void reweigh(float level);
  void even_out();
  float reach();
  float reach_after_memory();
  float level_of_y() const;
  void scale(float largest);

  LiveFocusSettings settings_;
  PackedArray packed_;
  Eigen::AlignedBox3f near_;
  ComplexRows g_, drive_, turns_;  // a row for each used focal point; q; (A17)
  ComplexRows phasors_, pulls_;    // G with all magnitudes 1, and gradients, for `adds_phasors`
  ComplexRows played_;             // outputs at the end of the last sample, with `memory`
  ComplexRows correlation_, magnitude_, x_, scratch_;  // for (A13)

  // for every focal point, by its index in the list
  std::array<Complex, kMaxLiveFoci> phase_;
  std::array<float, kMaxLiveFoci> weight_;
  std::array<Complex, kMaxLiveFoci> coefficient_{};

  // for the used focal points
  std::size_t count_ = 0;
  std::array<std::size_t, kMaxLiveFoci> place_{};
  // wanted pressure relative to alone_; Σ|G| [Pa]; Σ|G|²
  std::array<float, kMaxLiveFoci> wanted_{}, alone_{}, squares_{};
  std::array<Complex, kMaxLiveFoci> c_{}, y_{};
  std::array<Complex, kMaxLiveFoci> left_{};  // remainder of G times the last sample's outputs
  float fresh_ = 1.0F;                        // share of the scaled drives in the outputs
  float level_ = 0.0F, magnitude_of_drives_ = 0.0F;
};

}  // namespace prostm
