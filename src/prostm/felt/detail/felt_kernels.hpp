#pragma once
/// The products that take most of the computing time of a felt loss. Private to felt.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/focus_response.hpp"

namespace prostm {

/// Effect of a source of amplitude 1 on a cell, in all parts; or its derivative per mm of distance.
template <class Real>
struct alignas(64) FeltPair {
  std::array<Real, kFeltParts> part;
};

/// A pair in 16-bit fixed point: pairs are read many times, so memory traffic dominates. Values are
/// clamped to kMostFixed.
struct alignas(32) FeltFixed {
  std::array<std::int16_t, kFeltParts> part;
};
inline constexpr double kMostFixed = 32767.0;

/// The stored form of a pair.
template <class Real>
using FeltKept = std::conditional_t<std::is_same_v<Real, float>, FeltFixed, FeltPair<Real>>;

/// The spectrum of a source, laid out for its product with a row of the table: the real parts
/// twice, and the imaginary parts twice, first negated.
template <class Real>
struct alignas(64) FeltTurn {
  std::array<Real, kFeltParts> straight, crossed;
};

/// Number of values beyond its size that a list of sources must have, or that convolve() may write,
/// and beyond that, read.
inline constexpr std::size_t kFeltMargin = 4 * kFeltParts;

/// A cell and the sources, whose lists have a margin of kFeltMargin.
template <class Real>
struct FeltAround {
  Real cell_x, cell_y;
  const Real *x, *y;  ///< of the sources [mm]
  std::size_t sources;
};
inline constexpr double kLeastDistance = 1e-6;  ///< lower bound of a distance as a divisor [mm]

/// Stored pairs are in row-major order; a row is a cell on a skin.
template <class Real>
struct FeltKernels {
  /// Fills the rows of a cell, one per skin, and their slopes if `slopes` is not null. @param turns
  /// spectra of the sources.
  void (*fill)(std::span<const FocusResponse<Real>> skins, const FeltAround<Real>& around,
               const FeltTurn<Real>* turns, FeltKept<Real>* pairs, FeltKept<Real>* slopes);
  /// out[row] = Σ_source pair · amplitude.
  void (*forward)(const FeltKept<Real>* pairs, std::size_t rows, std::span<const Real> amplitude,
                  FeltPair<Real>* out);
  /// sum[source] += Σ_row pair · pull[row], part by part.
  void (*backward)(const FeltKept<Real>* pairs, std::size_t rows, const FeltPair<Real>* pull,
                   std::span<FeltPair<Real>> sum);
  /// sum_x[source] += Σ_part slope · pull · ∂distance/∂x, for one row; sum_y in the same way. Sums
  /// have a margin.
  void (*slide)(const FeltKept<Real>* slopes, const FeltPair<Real>& pull,
                const FeltAround<Real>& around, Real* sum_x, Real* sum_y);
  /// out[i] = Σ_t taps[t] · in[i + t · step].
  void (*convolve)(const Real* in, std::size_t step, std::span<const Real> taps, std::size_t size,
                   Real* out);
};

/// Returns plain loops.
FeltKernels<double> plain_felt_kernels();
/// Returns the vector kernels for this processor.
FeltKernels<float> fast_felt_kernels();

/// Returns the kernels for this precision.
template <class Real>
FeltKernels<Real> felt_kernels() {
  if constexpr (std::is_same_v<Real, float>) {
    return fast_felt_kernels();
  } else {
    return plain_felt_kernels();
  }
}

}  // namespace prostm
