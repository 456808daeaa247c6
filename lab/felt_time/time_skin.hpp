#pragma once
/// The percept of a pressure that need not be periodic: the skin stepped in time.

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

#include "prostm/acoustics/skin/detail/fft2.hpp"
#include "prostm/acoustics/skin/skin_model.hpp"
#include "prostm/acoustics/skin/skin_motion.hpp"

namespace prostm::bench {

/// Time between samples of pressure and of what is felt [s].
inline constexpr double kFeltTick = 0.2e-3;
/// Averaging time of a running percept [s].
inline constexpr double kFeltWindow = 0.040;

/// The half-space of (S1) to (S5) under any course of pressure on a raster. Its impulse response is
/// stepped by SkinStepper, (S12), for wave numbers 4 rad/m apart, and passed through the
/// sensitivity s(f) of (S6) as a filter up to 1 kHz that removes the mean. Displacements of
/// skin are convolutions with that, as in (S9), but in time too.
class TimeSkin {
 public:
  /// Steps the responses, some 10 s. @throws std::invalid_argument for rows or cols not in 1 to 64,
  /// cell not in 2 to 20 mm, or a skin without loss.
  TimeSkin(const SkinModel& model, const SkinPatch& patch);

  const SkinPatch& patch() const { return patch_; }

  /// Returns s ∗ w [m], the displacement as it is felt, for each tick and cell, tick by tick. The
  /// skin is at rest before the first tick.
  /// @param pressure ticks·rows·cols [Pa], band-limited by ticks and cells. @throws
  /// std::invalid_argument if the number of values is not a multiple of the cells.
  std::vector<float> respond(std::span<const float> pressure) const;

 private:
  class Blocks;
  void make_kernels(const SkinModel& model);

  SkinPatch patch_;
  Fft2 plane_;                                // of the padded raster
  std::vector<int> mode_of_;                  // index of the kernel of each padded place
  std::vector<std::complex<float>> kernels_;  // mode by mode: transform of the response in time
};

/// Returns √ of the mean of (s ∗ w)² over ticks first to first + count − 1, for each cell: √e [m].
/// @param response of TimeSkin::respond. @pre the ticks are in it, count ≥ 1
std::vector<double> percept_over(std::span<const float> response, std::size_t cells,
                                 std::size_t first, std::size_t count);

}  // namespace prostm::bench
