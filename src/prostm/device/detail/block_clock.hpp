#pragma once
/// The times when the blocks of a stream are asked for, due, and played.

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <chrono>
#include <cstdint>

namespace prostm {

/// The schedule of a device that plays a block every period from a queue of Q blocks, (A7). Block k
/// is asked for when block k − Q starts to play. It is late if it is filled more than a period
/// after that, and missed if it is not there at its play time. Each period without a block counts
/// as missed, and the stream goes on with block k at the next period: the schedule shifts, no
/// sample is skipped.
///
/// The queue begins at its greatest length and shortens while the machine is calm. It needs the
/// periods that the longest delay from asking to filling reached into, and one more, over the last
/// kRemembered times kCalm blocks, and no less than a bound. After every kCalm blocks, if it is
/// longer than that, blocks are asked for a period later. If a delay needs a longer queue, blocks
/// are asked for earlier at once, and no block is missed. A queue that still runs dry grows by the
/// missed periods: blocks are played that much later, but not asked for later. Has no clock: times
/// come from the caller.
class BlockClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  static constexpr std::int64_t kCalm = 1'000;  ///< blocks
  static constexpr std::size_t kRemembered = 20;

  /// Block 0 is asked for at `start`. @param least_blocks least length of the queue.
  /// @param most_blocks first and greatest length of the queue; if not above least_blocks, the
  /// length stays at least_blocks.
  BlockClock(Time start, Duration period, int least_blocks, int most_blocks = 0);

  /// Time by the present schedule for blocks not filled yet, by the past one for others, back to 64
  /// shifts.
  Time ask_time(std::int64_t block) const;
  Time play_time(std::int64_t block) const;
  /// Length of the queue for the next block.
  int queue_blocks() const { return static_cast<int>(shifts_.back().queue / period_); }

  struct Filled {
    bool late = false;
    std::int64_t missed = 0;  ///< periods without a block before this block
  };
  /// Records that block `block` was filled at `now`. Blocks come in order.
  Filled fill(std::int64_t block, Time now);

 private:
  struct Shift {
    std::int64_t block;  // first one of this shift
    Time start;          // ask time that block 0 would have
    Duration queue;      // from ask time to play time
  };
  static constexpr std::size_t kShifts = 64;

  const Shift& shift_of(std::int64_t block) const;
  void shift(std::int64_t block, Duration later, Duration longer);
  Duration needed(Duration delay) const;
  void lengthen(std::int64_t block, Duration delay, Time now);
  void shorten(std::int64_t block);

  Duration period_, least_, most_;  // duration of a block, bounds of the queue
  boost::container::static_vector<Shift, kShifts> shifts_;  // oldest first, never empty
  Time grown_at_{};  // time when blocks were last asked for earlier
  // the longest of each kCalm blocks, the newest first
  std::array<Duration, kRemembered> delays_{};
};

}  // namespace prostm
