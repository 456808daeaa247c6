#pragma once
/// A modulation that lets a block sound and falls silent by itself at its end.

#include <cstdint>
#include <span>

namespace prostm {

/// Times from the moment when the modulation begins [s].
struct SoundingTime {
  bool sounds = false;  ///< whether output is audible as the modulation begins
  double next = 0.0;    ///< begin of the block that was written last
  double end = 0.0;     ///< its end
};

/// Writes the modulation, an amplitude 0..255 a sample: full from `next` on, after a ramp if it was
/// silent before, and down to 0 by a ramp that ends at `end`. Its last sample is 0, and it is held.
/// So output stops at the end of the last whole block, whatever happens to who sends them.
/// @param ramp duration of either ramp [s]. @return number of samples written, at least 2.
/// @pre out holds end/sample + 2 samples, 0 ≤ next < end.
int write_dead_man(const SoundingTime& time, double ramp, double sample,
                   std::span<std::uint8_t> out);

}  // namespace prostm
