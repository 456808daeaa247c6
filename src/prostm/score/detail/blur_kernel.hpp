#pragma once
/// The inner loop of SkinBlur, by vectors of whatever length the processor has. Private to score.

#include <cstddef>
#include <span>

namespace prostm {

/// Computes to[i] = Σ_t taps[t] · from[t·step + i] for i < count; each sum runs over t upwards.
/// @pre `from` holds (taps.size() − 1)·step + count values; `to` holds count and does not overlap
/// them. Allocates nothing.
void weighted_sums(std::span<const double> taps, const double* from, std::size_t step,
                   std::size_t count, double* to);

}  // namespace prostm
