#pragma once
/// The inner loop of SkinBlur, vectorised for the processor's vector length. Private to score.

#include <cstddef>

namespace prostm {

/// Width of a strip, and number of sums along it computed at once: each value is loaded once for
/// all of them.
inline constexpr std::size_t kStripWidth = 16, kSumsAtOnce = 8;

/// Computes to[j][i] = Σ_k taps[k − j] · from[k][i] for k < count, j < kSumsAtOnce, i <
/// kStripWidth, where rows of `from` and `to` are kStripWidth long; each sum runs over k upwards.
/// @pre taps[1 − kSumsAtOnce] to taps[count − 1] exist; `to` does not overlap `from`. Allocates
/// nothing.
void strip_sums(const double* taps, const double* from, std::size_t count, double* to);

}  // namespace prostm
