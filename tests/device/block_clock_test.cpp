#include "device/block_clock.hpp"

#include <gtest/gtest.h>

namespace prostm {
namespace {

using namespace std::chrono_literals;

const BlockClock::Time kStart{1000s};

TEST(BlockClock, PunctualBlocksAreNeitherLateNorMissed) {
  BlockClock clock(kStart, 1ms, 8);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(clock.ask_time(k), kStart + k * 1ms);
    EXPECT_EQ(clock.play_time(k), kStart + (k + 8) * 1ms);
    const auto filled = clock.fill(k, clock.ask_time(k) + 1ms);  // at the deadline
    EXPECT_FALSE(filled.late);
    EXPECT_EQ(filled.missed, 0);
  }
}

TEST(BlockClock, LateWhenFilledAfterOnePeriod) {
  BlockClock clock(kStart, 1ms, 8);
  EXPECT_TRUE(clock.fill(0, kStart + 1ms + 1us).late);
  EXPECT_TRUE(clock.fill(1, kStart + 9ms).late);  // just in time to be played
  EXPECT_EQ(clock.fill(2, kStart + 10ms).missed, 0);
}

TEST(BlockClock, DryQueueCountsPeriodsAndShiftsTheSchedule) {
  BlockClock clock(kStart, 1ms, 8);
  EXPECT_FALSE(clock.fill(0, kStart).late);
  // block 1 is played at 9 ms, comes at 20.5 ms: nothing to play at 9, 10, … 20 ms
  const auto filled = clock.fill(1, kStart + 20ms + 500us);
  EXPECT_TRUE(filled.late);
  EXPECT_EQ(filled.missed, 12);
  EXPECT_EQ(clock.play_time(1), kStart + 21ms);
  EXPECT_EQ(clock.play_time(0), kStart + 8ms);  // as it was played
  EXPECT_EQ(clock.play_time(2), kStart + 22ms);
  // the queue fills up again at once: block 8 is asked for at 20 ms, block 9 when block 1 plays
  EXPECT_EQ(clock.ask_time(8), kStart + 20ms);
  EXPECT_EQ(clock.ask_time(9), kStart + 21ms);
  for (int k = 2; k <= 8; ++k) EXPECT_EQ(clock.fill(k, kStart + 20ms + 600us).missed, 0);
}

TEST(BlockClock, ManyShifts) {
  BlockClock clock(kStart, 1ms, 1);
  BlockClock::Time now = kStart;
  for (int k = 0; k < 500; ++k) {
    now += 3ms;
    EXPECT_EQ(clock.fill(k, now).late, true);
    EXPECT_GE(clock.play_time(k), now);
    EXPECT_LE(clock.play_time(k), now + 1ms);
  }
}

}  // namespace
}  // namespace prostm
