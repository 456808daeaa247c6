#pragma once
/// When the blocks of a stream are asked for, due, and played.

#include <boost/container/static_vector.hpp>
#include <chrono>
#include <cstdint>

namespace prostm {

/// The schedule of a device that plays a block every period from a queue of Q blocks, (A7). Block k
/// is asked for when block k − Q starts to play, is late when it is filled more than a period after
/// that, and missed when it is not there at its play time. Then every period without a block counts
/// as missed, and the stream goes on with block k at the next one: the schedule shifts, no sample
/// is skipped. No clock of its own: times come from the caller.
class BlockClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// Block 0 is asked for at `start`.
  BlockClock(Time start, Duration period, int queue_blocks);

  Time ask_time(std::int64_t block) const { return shifts_.back().start + block * period_; }
  /// As the schedule stands for blocks not filled yet; as it was played for the others, back to 64
  /// shifts.
  Time play_time(std::int64_t block) const;

  struct Filled {
    bool late = false;
    std::int64_t missed = 0;  ///< periods without a block before this one
  };
  /// Block `block` is in the queue since `now`. Blocks come in order.
  Filled fill(std::int64_t block, Time now);

 private:
  struct Shift {
    std::int64_t block;  // first one that follows
    Time start;          // ask time that block 0 would have
  };
  static constexpr std::size_t kShifts = 64;

  Duration period_, queue_;
  boost::container::static_vector<Shift, kShifts> shifts_;  // oldest first, never empty
};

}  // namespace prostm
