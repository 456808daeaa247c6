#pragma once
/// When the blocks of a stream are asked for, due, and played.

#include <algorithm>
#include <array>
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
/// The queue begins as long as it may get, and shortens while the machine proves calm. It needs one
/// period more than those that the longest delay from asking to filling reached into, of the last
/// kRemembered times kCalm blocks, and no less than a bound. After kCalm blocks each, while it is
/// longer than that, blocks are asked for a period later. When a delay calls for more than there
/// is, blocks are asked for earlier at once, and none is missed. A queue that ran dry all the same
/// grows by the periods that were missed, since blocks are played later by as many and asked for no
/// later. No clock of its own: times come from the caller.
class BlockClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  static constexpr std::int64_t kCalm = 1'000;  ///< blocks
  static constexpr std::size_t kRemembered = 20;

  /// Block 0 is asked for at `start`. @param least_blocks that the queue shortens to.
  /// @param most_blocks that it begins with; where that is not above least_blocks, it stays at
  /// least_blocks.
  BlockClock(Time start, Duration period, int least_blocks, int most_blocks = 0);

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
  void lengthen(std::int64_t block, Duration delay, Time now);
  void shorten(std::int64_t block);

  Duration period_, least_, most_;                          // of a block, and of the queue
  boost::container::static_vector<Shift, kShifts> shifts_;  // oldest first, never empty
  Time grown_at_{};  // when blocks were last asked for earlier
  std::array<Duration, kRemembered>
      delays_{};  // the longest of each kCalm blocks, the newest first
};

}  // namespace prostm
