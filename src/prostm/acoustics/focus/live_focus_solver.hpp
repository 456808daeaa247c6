#pragma once
/// Focus solvers that run for every sample of a stream.

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
  /// Per sample; GsPat, which gains little from the last one, takes 20. With `adds_phasors` up to
  /// two more follow while a share is off by 5 %.
  int iterations = 1;
  /// Steps per turn that the phases of drives, or of c with `adds_phasors`, are rounded to; 0: any
  /// phase.
  int phase_levels = 0;
  bool warm = true;  ///< whether a sample begins with the previous phases and weights
  /// Acoustic pressure (rms) of amplitude 1 [Pa], the same everywhere; 0: the pressure that the
  /// whole array makes there with a single focal point.
  double full_scale = 0.0;
  /// Where a single focal point gets less than full_scale, its share of full_scale counts as at
  /// least 1/bound, so that a far focal point does not take what nearer ones need.
  double bound = 2.0;
  /// For arrays that add up their own drives, as the phases of Σ_m c_m e^{−ik r_mn}: Weighted, but
  /// only c may be chosen, (A23). See coefficients().
  bool adds_phasors = false;
  /// With `adds_phasors`, the share of what transducers give out that is left after a sample,
  /// e^{−T/τ} of (A10) at resonance, 0..0.95; 0: no memory. The shares reached are then those at
  /// the end of a sample, if play() is called after each solve().
  double memory = 0.0;
};

/// A focal point in one sample.
struct LiveFocus {
  Eigen::Vector3f p_D = Eigen::Vector3f::Zero();  ///< [m]
  /// Wanted acoustic pressure over full_scale, or over that of a single focal point there, 0..1.
  float amplitude = 0.0F;
};

/// Finds the drives for one sample after another, in single precision with vector kernels. As in
/// solve_foci, amplitudes that are more than the array can do are lowered together, and no |q|
/// exceeds 1. A focal point is identified by its index in the list: its phase and weight are kept
/// from sample to sample, so that drives move smoothly when it does.
class LiveFocusSolver {
 public:
  /// @throws std::invalid_argument for an array that is not valid, a method that does not run live,
  /// iterations not in 1 to 1000, phase_levels neither 0 nor 2 to 65536, full_scale not in 0 to 1e6
  /// Pa, bound not in 1 to 100.
  LiveFocusSolver(const TransducerArray& array, const Medium& medium,
                  const LiveFocusSettings& settings);

  /// Finds the drives for these focal points. Focal points with an amplitude up to 1e-4 are silent
  /// and do not count. Nor do invalid ones: with a position or an amplitude that is out of range or
  /// not finite, behind the array, nearer than kNearestPoint to a transducer, or beyond
  /// kMaxLiveFoci. Allocates and throws nothing.
  void solve(std::span<const LiveFocus> foci) noexcept;

  /// q in row 0, a column for each transducer.
  const ComplexRows& drive() const { return drive_; }
  /// Share of the amplitudes that is reached together, Σ a |y| / Σ a², where y is relative to the
  /// pressure of each focal point alone, as a is; at most 1, and 0 without focal points. Taken
  /// before phases are rounded.
  float level() const { return level_; }
  /// c of a focal point in the last sample, by its index in the list, with `adds_phasors`: 0 for
  /// focal points that do not count, and the largest |c| is 1.
  std::complex<float> coefficient(std::size_t focus) const { return coefficient_[focus]; }
  /// Magnitude of all drives of the last sample, ≤ 1, with `adds_phasors`; 0 without focal points.
  float magnitude() const { return magnitude_of_drives_; }

  /// Lets transducers play the drives of the last solve(), with `adds_phasors` and `memory`.
  /// @param turn factor of all drives by which the array turns them against those of the sample
  /// before, |turn| = 1. The next solve() expects a turn of 1.
  void play(std::complex<float> turn) noexcept;

  /// Forgets the previous sample.
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
  ComplexRows g_, drive_, turns_;  // a row for each focal point that counts; q; (A17)
  ComplexRows phasors_, pulls_;    // G with all magnitudes 1, and gradients, for `adds_phasors`
  ComplexRows played_;             // outputs at the end of the last sample, with `memory`
  ComplexRows correlation_, magnitude_, x_, scratch_;  // for (A13)

  // for every focal point, by its index in the list
  std::array<Complex, kMaxLiveFoci> phase_;
  std::array<float, kMaxLiveFoci> weight_;
  std::array<Complex, kMaxLiveFoci> coefficient_{};

  // for the focal points that count
  std::size_t count_ = 0;
  std::array<std::size_t, kMaxLiveFoci> place_{};
  // relative to alone; Σ|G| [Pa]; Σ|G|²
  std::array<float, kMaxLiveFoci> wanted_{}, alone_{}, squares_{};
  std::array<Complex, kMaxLiveFoci> c_{}, y_{};
  std::array<Complex, kMaxLiveFoci> left_{};  // of G times the last sample's outputs
  float fresh_ = 1.0F;  // share of the drives, as they will be scaled, in the outputs
  float level_ = 0.0F, magnitude_of_drives_ = 0.0F;
};

}  // namespace prostm
