#pragma once
/// The products that take most of the time of a felt loss. Private to felt.

#include <cstddef>
#include <cstdint>

#include "prostm/felt/felt_loss.hpp"
#include "prostm/felt/focus_response.hpp"

namespace prostm {

/// Effect of a source of amplitude 1 on a cell, in all parts; or the same per mm of distance.
template <class Real>
struct alignas(64) FeltPair {
  std::array<Real, kFeltParts> part;
};

/// Functions for one skin. Pairs are cell by cell: [cell · sources + source].
template <class Real>
struct FeltKernels {
  /// Fills the pairs of one cell at (x, y); and their slopes, if that is not null.
  void (*fill)(const FocusResponse<Real>& response, Real x, Real y, const FeltSource<Real>* sources,
               std::size_t count, FeltPair<Real>* pairs, FeltPair<Real>* slopes);
  /// out[cell] = Σ_source pair · amplitude.
  void (*forward)(const FeltPair<Real>* pairs, std::size_t cells, std::size_t sources,
                  const Real* amplitude, FeltPair<Real>* out);
  /// sum[source] += Σ_cell pair · pull[cell], part by part.
  void (*backward)(const FeltPair<Real>* pairs, std::size_t cells, std::size_t sources,
                   const FeltPair<Real>* pull, FeltPair<Real>* sum);
  /// out[source] = Σ_part slope · pull, for one cell.
  void (*slide)(const FeltPair<Real>* slopes, std::size_t sources, const FeltPair<Real>& pull,
                Real* out);
};

/// Returns plain loops.
template <class Real>
FeltKernels<Real> plain_felt_kernels();
/// Returns the vector kernels for this processor, in single precision.
FeltKernels<float> fast_felt_kernels();

}  // namespace prostm
