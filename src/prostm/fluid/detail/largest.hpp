#pragma once
/// The largest value of a row, NaN and infinity among them.

#include <bit>
#include <cstdint>
#include <limits>

namespace prostm::fluid {

/// Returns the bits of the largest |x| in [begin, end), without a floating-point comparison: NaN
/// would trap there, and has the largest bits of all.
std::int32_t largest_bits(const float* begin, const float* end);

inline constexpr auto kLargestFinite =
    std::bit_cast<std::int32_t>(std::numeric_limits<float>::max());

}  // namespace prostm::fluid
