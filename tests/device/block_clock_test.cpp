#include "prostm/device/detail/block_clock.hpp"

#include <gtest/gtest.h>

#include "prostm/core/random.hpp"

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

TEST(BlockClock, BlocksAreLateAfterOnePeriod) {
  BlockClock clock(kStart, 1ms, 8);
  EXPECT_TRUE(clock.fill(0, kStart + 1ms + 1us).late);
  EXPECT_TRUE(clock.fill(1, kStart + 9ms).late);  // late, but in time to be played
  EXPECT_EQ(clock.fill(2, kStart + 10ms).missed, 0);
}

TEST(BlockClock, AnEmptyQueueCountsMissedPeriodsAndShiftsTheSchedule) {
  BlockClock clock(kStart, 1ms, 8);
  EXPECT_FALSE(clock.fill(0, kStart).late);
  // block 1, due at 9 ms, arrives at 20.5 ms: blocks are missed at 9, 10, … 20 ms
  const auto filled = clock.fill(1, kStart + 20ms + 500us);
  EXPECT_TRUE(filled.late);
  EXPECT_EQ(filled.missed, 12);
  EXPECT_EQ(clock.play_time(1), kStart + 21ms);
  EXPECT_EQ(clock.play_time(0), kStart + 8ms);  // its actual play time
  EXPECT_EQ(clock.play_time(2), kStart + 22ms);
  // the queue is refilled at once: block 8 is requested at 20 ms, block 9 when block 1 plays
  EXPECT_EQ(clock.ask_time(8), kStart + 20ms);
  EXPECT_EQ(clock.ask_time(9), kStart + 21ms);
  for (int k = 2; k <= 8; ++k) EXPECT_EQ(clock.fill(k, kStart + 20ms + 600us).missed, 0);
}

TEST(BlockClock, SurvivesManyShifts) {
  BlockClock clock(kStart, 1ms, 1);
  BlockClock::Time now = kStart;
  for (int k = 0; k < 500; ++k) {
    now += 3ms;
    EXPECT_EQ(clock.fill(k, now).late, true);
    EXPECT_GE(clock.play_time(k), now);
    EXPECT_LE(clock.play_time(k), now + 1ms);
  }
}

/// Fills blocks in order, each `delay` after it is requested, and checks that none is missed and
/// that they play without a gap while the queue changes its length.
class Filler {
 public:
  explicit Filler(BlockClock& clock) : clock_(clock) {}
  void fill_until(std::int64_t block, std::chrono::microseconds delay) {
    for (; block_ < block; ++block_) {
      now_ = std::max(now_, clock_.ask_time(block_) + delay);
      EXPECT_EQ(clock_.fill(block_, now_).missed, 0) << block_;
      if (block_ > 0) {
        EXPECT_EQ(clock_.play_time(block_), played_ + 1ms) << block_;
      }
      played_ = clock_.play_time(block_);
    }
  }
  void fill(int blocks, std::chrono::microseconds delay) { fill_until(block_ + blocks, delay); }
  std::int64_t block() const { return block_; }

 private:
  BlockClock& clock_;
  std::int64_t block_ = 0;  // the next block
  BlockClock::Time now_ = kStart, played_;
};

TEST(BlockClock, TheQueueStartsLongAndShortensOnACalmMachine) {
  BlockClock clock(kStart, 1ms, 3, 10);
  EXPECT_EQ(clock.queue_blocks(), 10);
  EXPECT_EQ(clock.play_time(0), kStart + 10ms);
  Filler filler(clock);
  filler.fill_until(2, 8ms);  // slow blocks right after the start are not missed
  EXPECT_EQ(clock.queue_blocks(), 10);

  BlockClock calm(kStart, 1ms, 3, 10);
  Filler calm_filler(calm);
  for (int queue = 10; queue > 3; --queue) {
    EXPECT_EQ(calm.queue_blocks(), queue);
    calm_filler.fill(BlockClock::kCalm, 100us);
  }
  EXPECT_EQ(calm.queue_blocks(), 3);
  calm_filler.fill(5 * BlockClock::kCalm, 100us);
  EXPECT_EQ(calm.queue_blocks(), 3);
}

TEST(BlockClock, DelaysAreRememberedForAWhile) {
  BlockClock clock(kStart, 1ms, 2, 10);
  Filler filler(clock);
  // delays of up to 3.2 ms need five blocks: one more than the four periods they extend over
  filler.fill(1, 3200us);
  const auto remembered = static_cast<std::int64_t>(BlockClock::kRemembered) * BlockClock::kCalm;
  filler.fill_until(remembered - 1, 100us);
  EXPECT_EQ(clock.queue_blocks(), 5);
  filler.fill_until(remembered + 4 * BlockClock::kCalm, 100us);
  EXPECT_EQ(clock.queue_blocks(), 2);
}

TEST(BlockClock, ANearlyEmptyQueueGrowsWithoutAMiss) {
  BlockClock clock(kStart, 1ms, 3, 10);
  Filler filler(clock);
  filler.fill(8 * BlockClock::kCalm, 100us);
  ASSERT_EQ(clock.queue_blocks(), 3);
  filler.fill(1, 1300us);
  EXPECT_EQ(clock.queue_blocks(), 3);  // 1.3 ms extend into the second period
  const std::int64_t k = filler.block();
  const BlockClock::Time asked = clock.ask_time(k + 1);
  filler.fill(1, 2500us);
  EXPECT_EQ(clock.queue_blocks(), 4);  // 2.5 ms into the third
  // the next block plays as before, and is requested one period earlier
  EXPECT_EQ(clock.ask_time(k + 1), asked - 1ms);
  // blocks due before the queue grew are requested when it grows: they are not late
  const BlockClock::Time grown = clock.ask_time(k) + 2500us;
  for (int i = 1; i <= 3; ++i) EXPECT_FALSE(clock.fill(k + i, grown + 100us).late);
  EXPECT_EQ(clock.queue_blocks(), 4);
  // no delay makes the queue exceed its limit
  for (int i = 4; i < 10; ++i) EXPECT_EQ(clock.fill(k + i, clock.play_time(k + i)).missed, 0);
  EXPECT_LE(clock.queue_blocks(), 10);
}

TEST(BlockClock, AQueueThatRanEmptyGrowsByTheShortfall) {
  BlockClock clock(kStart, 1ms, 3, 6);
  Filler filler(clock);
  filler.fill(4 * BlockClock::kCalm, 100us);
  ASSERT_EQ(clock.queue_blocks(), 3);
  const std::int64_t k = filler.block();
  const BlockClock::Time asked = clock.ask_time(k);
  // a block due after 3 ms arrives after 4.5 ms and plays after 5 ms
  EXPECT_EQ(clock.fill(k, asked + 4500us).missed, 2);
  EXPECT_EQ(clock.queue_blocks(), 5);
  EXPECT_EQ(clock.play_time(k), asked + 5ms);
  EXPECT_EQ(clock.ask_time(k), asked);  // unchanged
  EXPECT_EQ(clock.play_time(k - 1), asked + 2ms);
  EXPECT_EQ(clock.ask_time(k + 1), asked + 1ms);
  EXPECT_EQ(clock.play_time(k + 1), asked + 6ms);
  EXPECT_EQ(clock.fill(k + 1, asked + 4600us).missed, 0);
  // 5 ms too late: the queue may grow by one block only, so the schedule shifts by the other four
  EXPECT_EQ(clock.fill(k + 2, clock.play_time(k + 2) + 4500us).missed, 5);
  EXPECT_EQ(clock.queue_blocks(), 6);
  EXPECT_EQ(clock.ask_time(k + 2), asked + 6ms);
  EXPECT_EQ(clock.play_time(k + 2), asked + 12ms);
}

TEST(BlockClock, RandomDelaysKeepTheScheduleConsistent) {
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
      // blocks play one after the other, spaced by the periods missed between them
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
