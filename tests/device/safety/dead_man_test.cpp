#include "prostm/device/safety/detail/dead_man.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

constexpr double kRamp = 1.5e-3, kSample = 0.25e-3;

TEST(DeadMan, FadesToSilenceInTime) {
  Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    SoundingTime time;
    time.sounds = random.uniform(0.0, 1.0) < 0.5;
    time.next = random.uniform(0.0, 0.02);
    time.end = time.next + random.uniform(0.0, 0.04);
    std::array<std::uint8_t, 254> levels{};
    const int count = write_dead_man(time, kRamp, kSample, levels);
    ASSERT_GE(count, 2);
    ASSERT_LE(count, 254);
    ASSERT_EQ(levels[static_cast<std::size_t>(count - 1)], 0);
    if (count > 2) {
      ASSERT_LE(count * kSample, time.end + 1e-12);
    }
    for (int k = 1; k < count; ++k) {
      const int change =
          levels[static_cast<std::size_t>(k)] - levels[static_cast<std::size_t>(k - 1)];
      ASSERT_LE(std::abs(change), 86);  // 2 samples of a ramp of 6
    }
    if (!time.sounds && time.next > kSample) {
      ASSERT_EQ(levels[0], 0);
    }
    if (time.sounds && time.end > 3.0 * kRamp) {
      ASSERT_EQ(levels[0], 255);
    }
  }
}

}  // namespace
}  // namespace prostm
