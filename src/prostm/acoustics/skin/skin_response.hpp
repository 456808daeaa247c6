#pragma once
/// The steady vibration of infinite skin under a periodic pressure: a sum over the harmonics of the
/// draw rate, (S9) to (S11) of docs/design/skin.md.

#include <array>
#include <complex>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/detail/fft2.hpp"
#include "prostm/acoustics/skin/skin_model.hpp"
#include "prostm/acoustics/skin/skin_motion.hpp"

namespace prostm {

/// The part of the compliance T of (S3) to use.
enum class SkinPart {
  Whole,
  Near,  ///< T without the surface wave's pole, (S14)
};

/// The response of a patch of infinite skin: waves that leave the patch do not come back. The
/// pressure is assumed to be band-limited by the spacing of cell centres and of samples.
class SkinResponse : public SkinMotion {
 public:
  /// @throws std::invalid_argument for rows or cols not in 1 to 512, cell not in 0.1 to 20 mm, or a
  /// skin without loss, whose waves would never die out.
  SkinResponse(const SkinModel& model, const SkinPatch& patch, SkinPart part = SkinPart::Whole);

  /// Prepares for loops of this period and number of samples: the harmonics n/period up to
  /// `highest` [Hz] with n < samples/2. This takes much longer than `respond`, and allocates.
  /// @throws std::invalid_argument for a period not in 0.2 ms to 250 ms, samples not in 3 to 4096,
  /// highest not in 1 Hz to 10 kHz or below the first harmonic.
  void prepare(double period, int samples, double highest = 1000.0);

  /// Computes the response to a loop, (S9). Allocates nothing. @throws std::invalid_argument if the
  /// period or the samples are not those of `prepare`, or the number of values does not match them.
  void respond(const PressureLoop& loop);

 private:
  static constexpr int kTaps = 12;
  struct RadiusPlace {
    int first = 0;                       // index of the first radius in the table
    std::array<double, kTaps> weight{};  // weights of this and the following radii
  };
  static RadiusPlace place_of(double radius);
  void make_radii();
  std::complex<double> integrand(double k, double omega) const;
  void make_kernels(double period);

  SkinModel model_;
  SkinPart part_;
  Fft2 fft_;
  // Green's functions: the distances (radii) between cells, and J_0(k r) for even radii
  std::vector<int> radius_of_;       // index of the radius of each cell of the padded raster
  std::vector<RadiusPlace> places_;  // position of each radius in the table
  Eigen::MatrixXd bessel_;           // radii of the table × wave numbers
  std::vector<std::complex<double>> kernels_;  // their transforms, padded, one for each harmonic
  std::vector<std::complex<double>> padded_;
};

}  // namespace prostm
