#include "device/block_clock.hpp"

#include <gtest/gtest.h>

#include "core/random.hpp"

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

TEST(BlockClock, AQueueThatRanDryGrowsByWhatItLacked) {
  BlockClock clock(kStart, 1ms, 3, 6);
  EXPECT_EQ(clock.queue_blocks(), 3);
  EXPECT_EQ(clock.fill(0, kStart).missed, 0);
  // block 1 was to be played at 4 ms and comes at 5.5 ms: played at 6 ms
  EXPECT_EQ(clock.fill(1, kStart + 5500us).missed, 2);
  EXPECT_EQ(clock.queue_blocks(), 5);
  EXPECT_EQ(clock.play_time(1), kStart + 6ms);
  EXPECT_EQ(clock.ask_time(1), kStart + 1ms);  // as before
  EXPECT_EQ(clock.play_time(0), kStart + 3ms);
  EXPECT_EQ(clock.ask_time(2), kStart + 2ms);
  EXPECT_EQ(clock.play_time(2), kStart + 7ms);
  EXPECT_EQ(clock.fill(2, kStart + 3500us).missed, 0);
  // 5 ms too late: the queue may grow by one block only, the schedule shifts by the other four
  EXPECT_EQ(clock.fill(3, clock.play_time(3) + 4500us).missed, 5);
  EXPECT_EQ(clock.queue_blocks(), 6);
  EXPECT_EQ(clock.ask_time(3), kStart + 7ms);
  EXPECT_EQ(clock.play_time(3), kStart + 13ms);
}

TEST(BlockClock, AQueueThatWasNearlyDryGrowsWithoutAMiss) {
  BlockClock clock(kStart, 1ms, 3, 10);
  EXPECT_EQ(clock.fill(0, kStart + 1300us).missed, 0);
  EXPECT_EQ(clock.queue_blocks(), 3);  // 1.3 ms reach into the second period
  EXPECT_EQ(clock.fill(1, kStart + 3500us).missed, 0);
  EXPECT_EQ(clock.queue_blocks(), 4);  // 2.5 ms into the third
  // what comes is played as before, and asked for a period earlier
  EXPECT_EQ(clock.play_time(1), kStart + 4ms);
  EXPECT_EQ(clock.play_time(2), kStart + 5ms);
  EXPECT_EQ(clock.ask_time(2), kStart + 1ms);
  EXPECT_EQ(clock.ask_time(5), kStart + 4ms);
  // the blocks that were due before the queue grew are asked for when it grew: they are not late
  for (int k = 2; k <= 4; ++k) EXPECT_FALSE(clock.fill(k, kStart + 3600us).late);
  EXPECT_EQ(clock.queue_blocks(), 4);
  clock.fill(5, kStart + 4ms);
  // no delay makes it longer than it may be
  EXPECT_EQ(clock.fill(6, clock.play_time(6)).missed, 0);
  EXPECT_EQ(clock.fill(7, clock.play_time(7)).missed, 0);
  EXPECT_EQ(clock.fill(8, clock.play_time(8)).missed, 0);
  EXPECT_LE(clock.queue_blocks(), 10);
}

TEST(BlockClock, AQueueThatIsLongerThanNeededShortensWithoutAMiss) {
  BlockClock clock(kStart, 1ms, 2, 10);
  EXPECT_EQ(clock.fill(0, kStart + 7500us).missed, 6);
  EXPECT_EQ(clock.queue_blocks(), 8);
  std::int64_t k = 1;
  BlockClock::Time played = clock.play_time(0);
  const auto go_on = [&](std::int64_t until, std::chrono::microseconds delay) {
    for (; k < until; ++k) {
      EXPECT_EQ(clock.fill(k, clock.ask_time(k) + delay).missed, 0) << k;
      EXPECT_EQ(clock.play_time(k), played + 1ms) << k;  // no gap, whatever the queue
      played = clock.play_time(k);
    }
  };
  // delays of up to 3.2 ms need five blocks: one more than the four periods they reach into
  go_on(BlockClock::kCalm, 3200us);
  EXPECT_EQ(clock.queue_blocks(), 8);
  go_on(BlockClock::kCalm + 2, 100us);
  EXPECT_EQ(clock.queue_blocks(), 5);
  go_on(2 * BlockClock::kCalm + 5, 100us);
  EXPECT_EQ(clock.queue_blocks(), 2);
  go_on(4 * BlockClock::kCalm, 100us);
  EXPECT_EQ(clock.queue_blocks(), 2);
}

TEST(BlockClock, RandomDelaysNeverBreakTheSchedule) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    BlockClock clock(kStart, 1ms, 1 + static_cast<int>(random.below(10)), 10);
    BlockClock::Time now = kStart, played = kStart;
    for (std::int64_t k = 0; k < 1000; ++k) {
      now = std::max(now, clock.ask_time(k));
      const double rare = random.uniform();
      now += std::chrono::microseconds(
          static_cast<int>(rare < 0.02 ? 20'000.0 * random.uniform() : 500.0 * rare));
      const auto filled = clock.fill(k, now);
      ASSERT_GE(clock.play_time(k), now) << seed;
      // blocks play one after the other, apart by the periods that were missed between them
      if (k > 0) {
        ASSERT_EQ(clock.play_time(k), played + (1 + filled.missed) * 1ms) << seed;
      }
      played = clock.play_time(k);
      ASSERT_GE(clock.queue_blocks(), 1) << seed;
      ASSERT_LE(clock.queue_blocks(), 10) << seed;
    }
  }
}

}  // namespace
}  // namespace prostm
