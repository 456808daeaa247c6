#pragma once
/// The steady vibration of a patch of skin under a periodic pressure, by harmonics: the part common
/// to all models of the skin. (S9) and (S10) of docs/design/skin.md.

#include <complex>
#include <span>
#include <vector>

namespace prostm {

/// A flat patch of skin: cell centres at (i·cell, j·cell), row-major, column i fastest.
struct SkinPatch {
  int rows = 0, cols = 0;
  double cell = 0.0;  ///< [m]

  std::size_t size() const { return static_cast<std::size_t>(rows * cols); }
};

/// Radiation pressure on a patch over one period. For paths of different periods, the caller
/// chooses a common one.
struct PressureLoop {
  double period = 0.0;               ///< [s]
  int samples = 0;                   ///< K, at the times k·period/K
  std::span<const double> pressure;  ///< K × rows·cols [Pa]
};

/// Displacement of a patch by harmonics of the draw rate.
class SkinMotion {
 public:
  const SkinPatch& patch() const { return patch_; }
  /// Number N of harmonics; n runs from 1 to N. The mean over a period, harmonic 0, is excluded,
  /// since it causes no vibration.
  int harmonics() const { return harmonics_; }
  /// Frequency n/period of harmonic n [Hz].
  double frequency(int n) const { return n / period_; }
  /// W_n [m], rows·cols: the displacement into the skin is Σ_n Re(W_n e^{2πi n t/period}).
  std::span<const std::complex<double>> displacement(int n) const;

 protected:
  // protected, since they are not virtual: models are destroyed as what they are
  ~SkinMotion() = default;
  SkinMotion(const SkinMotion&) = default;
  SkinMotion(SkinMotion&&) = default;
  SkinMotion& operator=(const SkinMotion&) = default;
  SkinMotion& operator=(SkinMotion&&) = default;

  /// @throws std::invalid_argument for rows or cols not in 1 to 512, or cell not in 0.1 to 20 mm.
  explicit SkinMotion(const SkinPatch& patch);

  /// Chooses the harmonics n/period up to `highest` [Hz] with n < samples/2.
  /// @throws std::invalid_argument for a period not in 0.2 ms to 250 ms, samples not in 3 to 4096,
  /// highest not in 1 Hz to 10 kHz or below the first harmonic.
  void choose_harmonics(double period, int samples, double highest);
  /// Checks a loop and writes the pressure P_n [Pa] of (S9) in place of the displacement. Allocates
  /// nothing. @throws std::invalid_argument if the loop is not of the period, samples and cells.
  void load(const PressureLoop& loop);
  /// Returns P_n of load(), to be overwritten with W_n.
  std::span<std::complex<double>> harmonic(int n);

 private:
  static constexpr std::size_t kBlock = 64;  // cells whose sums stay in the cache
  void fold_block();
  void sum_harmonic(int n, std::span<std::complex<double>> out) const;

  SkinPatch patch_;
  double period_ = 0.0;
  int samples_ = 0, harmonics_ = 0;
  std::vector<std::complex<double>> displacement_;
  std::vector<std::complex<double>> wave_;  // 2/K e^{−2πi k/K} of K samples
  std::vector<double> block_;               // pressures of a block of cells, sample by sample
};

/// Computes the rms velocity of the skin [m/s] in every cell, (S10). @param out rows·cols
void rms_velocity(const SkinMotion& motion, std::span<double> out);

/// Computes the amplitude of the velocity [m/s] of each harmonic at a cell: the spectrum at that
/// point.
/// @param out one value per harmonic. @pre 0 ≤ cell < rows·cols
void velocity_spectrum(const SkinMotion& motion, int cell, std::span<double> out);

}  // namespace prostm
