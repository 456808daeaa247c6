#pragma once
/// How badly the percept of a loop renders its target, on several skins at once, and the gradient
/// of that: equations (W2) to (W4) of docs/design/planner-felt.md.

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "prostm/felt/felt_cells.hpp"
#include "prostm/felt/focus_response.hpp"
#include "prostm/felt/render_lack.hpp"

namespace prostm {

/// A place where pressure acts, and how much of each harmonic it has there for a pressure of 1.
template <class Real>
struct FeltSource {
  Real x = 0, y = 0;                           ///< [mm]
  std::array<Real, kFeltParts> spectrum = {};  ///< real parts, then imaginary parts
};

/// Weights of the parts of the loss (W4).
struct FeltWeights {
  double fine = 0.3;       ///< of 1 − S_0 beside 1 − S_8.5
  double energy = 0.2;     ///< of 1 − S_8.5 of e, beside that of √e
  double loudness = 0.02;  ///< of the logarithm of the loudness over that to keep
  double quiet = 3.0;      ///< of the square of how much that is below −kSlack
  static constexpr double kSlack = 0.03;
};

/// The skins that a loop is felt on, one table each.
template <class Real>
using FeltSkins = std::vector<FocusResponse<Real>>;

/// Sized once; nothing else allocates. In single precision it runs on vector kernels; in double
/// precision on plain loops, as the reference.
template <class Real>
class FeltLoss {
 public:
  /// @param skins number of skins. @param most_cells, most_sources that set_target() and
  /// set_sources() will be given. @param with_slopes whether slide() will be called.
  FeltLoss(std::size_t skins, std::size_t most_cells, std::size_t most_sources,
           const FeltWeights& weights, bool with_slopes);
  ~FeltLoss();
  FeltLoss(FeltLoss&&) noexcept;
  FeltLoss& operator=(FeltLoss&&) noexcept;

  /// Takes over the cells. @pre some pressure is above 0.
  void set_target(const FeltCells& cells);
  /// Takes over the places where pressure acts. @pre as many skins as in the constructor.
  void set_sources(const FeltSkins<Real>& skins, std::span<const FeltSource<Real>> sources);
  /// Computes the loss (W4). @param amplitude of each source, of either sign; not all 0.
  Real evaluate(std::span<const Real> amplitude);
  /// Does the same, and takes so many times the loudness of that on each skin as the one to keep.
  Real keep_loudness(std::span<const Real> amplitude, Real times);
  /// Computes the gradient of the last evaluate() with respect to the amplitudes.
  void gradient(std::span<Real> gradient);
  /// Computes the gradient of the last evaluate() with respect to the places [1/mm].
  void slide(std::span<const Real> amplitude, std::span<Real> gradient_x,
             std::span<Real> gradient_y);
  /// Computes the gradient of the last evaluate() with respect to the moments at which the sources
  /// act, as shares of the loop. @param first first harmonic of their spectra.
  void turn(std::span<const Real> amplitude, int first, std::span<Real> gradient);

  /// Tells how badly other fields in the cells render the target of set_target().
  RenderLack<Real>& rendering();
  /// Percepts √e of the last evaluate() in each cell, by skin [µm per unit of amplitude].
  std::span<const Real> percept(std::size_t skin) const;
  /// Loudness of the last evaluate(): the geometric mean over the skins of the rms percept.
  Real loudness() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

extern template class FeltLoss<float>;
extern template class FeltLoss<double>;

}  // namespace prostm
