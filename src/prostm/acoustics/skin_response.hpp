#pragma once
/// The steady vibration of the skin under a periodic pressure: a sum over the harmonics of the draw
/// rate, (S9) to (S11) of docs/design.md.

#include <complex>
#include <span>
#include <vector>

#include "prostm/acoustics/detail/fft2.hpp"
#include "prostm/acoustics/skin_model.hpp"

namespace prostm {

/// A flat patch of skin: cell centres at (i·cell, j·cell), row-major, column i fastest.
struct SkinPatch {
  int rows = 0, cols = 0;
  double cell = 0.0;  ///< [m]
};

/// Radiation pressure on a patch over one period. Callers bring paths of different periods to a
/// common one.
struct PressureLoop {
  double period = 0.0;               ///< [s]
  int samples = 0;                   ///< K, at the times k·period/K
  std::span<const double> pressure;  ///< K·rows·cols, sample by sample [Pa]
};

/// The response of a patch of skin without bounds: waves that leave the patch do not come back. The
/// pressure is taken as band-limited by the spacing of cell centres and of samples.
class SkinResponse {
 public:
  /// @throws std::invalid_argument for rows or cols not in 1 to 512, cell not in 0.1 to 20 mm, or a
  /// skin without loss, whose waves would never die out.
  SkinResponse(const SkinModel& model, const SkinPatch& patch);

  /// Prepares for loops of this period and number of samples: the harmonics n/period up to
  /// `highest` [Hz] with n < samples/2. This takes much longer than `respond`, and allocates.
  /// @throws std::invalid_argument for a period not in 0.2 ms to 250 ms, samples not in 3 to 4096,
  /// highest not in 1 Hz to 10 kHz or below the first harmonic.
  void prepare(double period, int samples, double highest = 1000.0);

  /// Computes the response to a loop, (S9). Allocates nothing. @throws std::invalid_argument if the
  /// period or the samples are not those of `prepare`, or the number of values does not match them.
  void respond(const PressureLoop& loop);

  const SkinPatch& patch() const { return patch_; }
  /// Number N of harmonics; n runs from 1 to N. The mean over a period, harmonic 0, is left out,
  /// since it does not move the skin.
  int harmonics() const { return harmonics_; }
  /// Frequency n/period of harmonic n [Hz].
  double frequency(int n) const { return n / period_; }
  /// W_n [m], rows·cols: the displacement into the skin is Σ_n Re(W_n e^{2πi n t/period}).
  std::span<const std::complex<double>> displacement(int n) const;

 private:
  void make_radii();
  void make_kernel(double omega, std::span<std::complex<double>> kernel);
  void transform_in_time(const PressureLoop& loop);

  SkinModel model_;
  SkinPatch patch_;
  Fft2 fft_;
  Eigen::FFT<double> time_fft_;
  double period_ = 0.0;
  int samples_ = 0, harmonics_ = 0;
  // Green's functions: the distances (radii) between cells, and J_0(k r) for each of them
  std::vector<int> radius_of_;  // index of the radius of each cell of the padded raster
  Eigen::MatrixXd bessel_;      // radii × wave numbers
  std::vector<std::complex<double>> kernels_;  // their transforms, padded, one for each harmonic
  std::vector<std::complex<double>> displacement_, padded_, spectrum_;
  std::vector<double> course_;  // pressure of one cell over the period
};

/// Computes the rms velocity of the skin [m/s] in every cell, (S10). @param out rows·cols
void rms_velocity(const SkinResponse& response, std::span<double> out);

/// Computes the amplitude of the velocity [m/s] of each harmonic at a cell: the spectrum at that
/// point.
/// @param out one value per harmonic. @pre 0 ≤ cell < rows·cols
void velocity_spectrum(const SkinResponse& response, int cell, std::span<double> out);

}  // namespace prostm
