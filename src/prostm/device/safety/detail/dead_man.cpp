#include "prostm/device/safety/detail/dead_man.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {

int write_dead_man(const SoundingTime& time, double ramp, double sample,
                   std::span<std::uint8_t> out) {
  const int room = static_cast<int>(out.size());
  const int count = std::clamp(static_cast<int>(time.end / sample), 2, room);
  for (int i = 0; i < count; ++i) {
    const double at = i * sample;
    const double rise = time.sounds ? 1.0 : (at - time.next) / ramp;
    const double fall = (time.end - at - sample) / ramp;
    const double level = std::clamp(std::min(rise, fall), 0.0, 1.0);
    out[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::lround(255.0 * level));
  }
  out[static_cast<std::size_t>(count - 1)] = 0;
  return count;
}

}  // namespace prostm
