#include "prostm/device/autd3/detail/turn_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr milliseconds kPeriod{20};

TEST(TurnClock, FollowsTurnsThroughLateAnswers) {
  for (const double drift : {-1e-4, 0.0, 1e-4}) {  // drift of the device's clock
    TurnClock clock;
    const TurnClock::Time begin{};
    clock.start(begin, 0, kPeriod);
    Random random(1);
    std::int64_t asked = 0;  // [µs]
    for (int i = 0; i < 20'000; ++i) {
      asked += static_cast<std::int64_t>(random.uniform(200.0, 900.0));
      const double turns = std::floor(static_cast<double>(asked) / (20e3 * (1.0 + drift)) + 0.3);
      // the answer takes some time to arrive
      const auto seen = asked + static_cast<std::int64_t>(random.uniform(20.0, 300.0));
      clock.see(begin + microseconds(asked - 20), begin + microseconds(seen),
                static_cast<int>(turns) % 2);
      if (turns < 50) continue;
      ASSERT_EQ(clock.turns(), static_cast<std::int64_t>(turns));
      const double turned = (turns - 0.3) * 20e3 * (1.0 + drift);
      const auto since = [&](TurnClock::Time time) {
        return std::chrono::duration<double, std::micro>(time - begin).count();
      };
      ASSERT_LE(since(clock.earliest()), turned + 1.0);
      ASSERT_GE(since(clock.latest()), turned - 1.0);
      ASSERT_LT(since(clock.latest()) - since(clock.earliest()), 600.0);
    }
  }
}

TEST(TurnClock, CountsTurnsThatNoAnswerReported) {
  TurnClock clock;
  const TurnClock::Time begin{};
  clock.start(begin, 0, kPeriod);
  clock.see(begin + milliseconds(7), begin + milliseconds(7), 1);
  clock.see(begin + milliseconds(70), begin + milliseconds(70),
            0);  // after those at 27 and 47 ms, that at 67 ms
  EXPECT_EQ(clock.turns(), 4);
  EXPECT_EQ(clock.playing(), 0);
  clock.see(begin + milliseconds(71), begin + milliseconds(71), -1);
  EXPECT_EQ(clock.turns(), 4);
}

}  // namespace
}  // namespace prostm
