#pragma once
/// When the blocks of a stream are asked for, due, and played.

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <chrono>
#include <cstdint>

namespace prostm {

/// The schedule of a device that plays a block every period from a queue of Q blocks, (A7). Block k
/// is asked for when block k − Q starts to play, is late when it is filled more than a period after
/// that, and missed when it is not there at its play time. Then every period without a block counts
/// as missed, and the stream goes on with block k at the next one: the schedule shifts, no sample
/// is skipped.
///
/// The queue is as long as the machine's delays ask for, up to a bound: one period more than those
/// that the longest delay from asking to filling reached into. When a delay calls for more, blocks
/// are asked for earlier at once, and none is missed. A queue that ran dry all the same grows by
/// the periods that were missed, since blocks are played later by as many and asked for no later.
/// When for kCalm blocks less was enough, blocks are asked for later until the queue is as long as
/// was needed, and no shorter than at the start. No clock of its own: times come from the caller.
class BlockClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  static constexpr std::int64_t kCalm = 20'000;  ///< blocks

  /// Block 0 is asked for at `start`. @param most_blocks that the queue grows to; where it is not
  /// above queue_blocks, the queue stays as it is.
  BlockClock(Time start, Duration period, int queue_blocks, int most_blocks = 0);

  /// As the schedule stands for blocks not filled yet; as it was for the others, back to 64 shifts.
  Time ask_time(std::int64_t block) const;
  Time play_time(std::int64_t block) const;
  /// The queue of the next block.
  int queue_blocks() const { return static_cast<int>(shifts_.back().queue / period_); }

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
    Duration queue;      // from there to its play time
  };
  static constexpr std::size_t kShifts = 64;

  const Shift& shift_of(std::int64_t block) const;
  void shift(std::int64_t block, Duration later, Duration longer);
  Duration needed(Duration delay) const;
  void watch(std::int64_t block, Duration delay, Time now);

  Duration period_, least_, most_;                          // of a block, and of the queue
  boost::container::static_vector<Shift, kShifts> shifts_;  // oldest first, never empty
  std::int64_t watched_since_ = 0;                          // block
  Time grown_at_{};           // when blocks were last asked for earlier
  Duration longest_delay_{};  // from asking to filling, of the blocks since then
};

}  // namespace prostm
