#pragma once
/// Loss of the percept of a loop against its target, on several skins at once, and its gradient:
/// equations (W2) to (W4) of docs/design/planner-felt.md.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "prostm/felt/felt_cells.hpp"
#include "prostm/felt/focus_response.hpp"
#include "prostm/felt/render_lack.hpp"

namespace prostm {

/// A point source of pressure, and the spectrum of its pressure over the loop for an amplitude
/// of 1.
template <class Real>
struct FeltSource {
  Real x = 0, y = 0;                           ///< [mm]
  std::array<Real, kFeltParts> spectrum = {};  ///< real parts, then imaginary parts
};

/// Weights of the parts of the loss (W4).
struct FeltWeights {
  double fine = 0.3;       ///< weight of 1 − S_0, relative to 1 − S_8.5
  double energy = 0.2;     ///< weight of 1 − S_8.5 of e, relative to that of √e
  double loudness = 0.02;  ///< weight of ρ, the log of the loudness over the one to keep
  double quiet = 3.0;      ///< weight of max(0, −ρ − kSlack)²
  static constexpr double kSlack = 0.03;
};

/// Tables of the skins on which the percept is computed.
template <class Real>
using FeltSkins = std::vector<FocusResponse<Real>>;

/// The loss (W4). Only construction allocates. Single precision uses vector kernels; double
/// precision uses plain loops, as the reference.
template <class Real>
class FeltLoss {
 public:
  /// @param skins number of skins. @param most_cells, most_sources capacity for set_target() and
  /// set_sources(). @param with_slopes whether slide() will be called.
  FeltLoss(std::size_t skins, std::size_t most_cells, std::size_t most_sources,
           const FeltWeights& weights, bool with_slopes);
  ~FeltLoss();
  FeltLoss(FeltLoss&&) noexcept;
  FeltLoss& operator=(FeltLoss&&) noexcept;

  /// Sets the cells. @pre some pressure is above 0.
  void set_target(const FeltCells& cells);
  /// Sets the sources of pressure. @pre as many skins as in the constructor.
  void set_sources(std::span<const FocusResponse<Real>> skins,
                   std::span<const FeltSource<Real>> sources);
  /// Computes the loss (W4), which is finite for silence, too. @param amplitude signed amplitude of
  /// each source.
  Real evaluate(std::span<const Real> amplitude);
  /// Same as evaluate(), and makes `times` times this loudness, on each skin, the one to keep.
  Real keep_loudness(std::span<const Real> amplitude, Real times);
  /// Computes the gradient of the last evaluate() with respect to the amplitudes.
  void gradient(std::span<Real> gradient);
  /// Computes the gradient of the last evaluate() with respect to the sources' positions [1/mm].
  void slide(std::span<const Real> amplitude, std::span<Real> gradient_x,
             std::span<Real> gradient_y);
  /// Computes the gradient of the last evaluate() with respect to the times of the sources, as
  /// shares of the loop. @param first first harmonic of their spectra.
  void turn(std::span<const Real> amplitude, int first, std::span<Real> gradient);

  /// Returns the rendering loss, for other fields in the cells, against the target of set_target().
  RenderLack<Real>& rendering();
  /// Percepts √e of the last evaluate() in each cell, by skin [µm per unit of amplitude].
  std::span<const Real> percept(std::size_t skin) const;
  /// Lack of the last evaluate(): (W2) without its part for e, the mean over the skins.
  Real lack() const;
  /// 1 − S_8.5 of √e of the last evaluate(), the mean over the skins.
  Real coarse_lack() const;
  /// Loudness of the last evaluate(): the geometric mean over the skins of the rms percept.
  Real loudness() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class FeltLoss<float>;
extern template class FeltLoss<double>;

}  // namespace prostm
