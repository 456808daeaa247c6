#pragma once
/// A modulation that makes a block audible and falls silent by itself at the block's end.

#include <cstdint>
#include <span>

namespace prostm {

/// Times relative to the beginning of the modulation [s].
struct SoundingTime {
  bool sounds = false;  ///< whether output is audible when the modulation begins
  double next = 0.0;    ///< beginning of the newest block
  double end = 0.0;     ///< end of that block
};

/// Writes the modulation, an amplitude 0..255 per sample: full from `next` on, with a ramp up if
/// output was silent before, and a ramp down to 0 that ends at `end`. The last sample is 0 and is
/// held, so output stops at the end of the last whole block, whatever happens to the sender.
/// @param ramp duration of either ramp [s]. @return number of samples written, at least 2.
/// @pre out holds end/sample + 2 samples, 0 ≤ next < end.
int write_dead_man(const SoundingTime& time, double ramp, double sample,
                   std::span<std::uint8_t> out);

}  // namespace prostm
