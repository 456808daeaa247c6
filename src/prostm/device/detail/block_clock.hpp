#pragma once
/// Times at which the blocks of a stream are requested, due and played.

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <chrono>
#include <cstdint>

namespace prostm {

/// The schedule of a device that plays a block every period from a queue of Q blocks, (A7). Block k
/// is requested when block k − Q starts to play. It is late if it is filled more than a period
/// after that, and missed if it is not filled by its play time. Each period without a block counts
/// as missed, and block k plays in the next period: the schedule shifts, and no sample is skipped.
///
/// The queue starts at its greatest length and shortens while the machine is calm. It needs as many
/// periods as the longest delay from request to fill reached into, over the last kRemembered ·
/// kCalm blocks, plus one, but not less than a bound. After every kCalm blocks a queue that is
/// longer than that shrinks: blocks are requested a period later. If a delay needs a longer queue,
/// blocks are requested earlier at once, and none is missed. A queue that still runs empty grows by
/// the missed periods: blocks are played that much later, but not requested later. Has no clock of
/// its own: the caller passes the times.
class BlockClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  static constexpr std::int64_t kCalm = 1'000;  ///< blocks
  static constexpr std::size_t kRemembered = 20;

  /// Block 0 is requested at `start`. @param least_blocks least length of the queue.
  /// @param most_blocks first and greatest length of the queue; if not above least_blocks, the
  /// length stays at least_blocks.
  BlockClock(Time start, Duration period, int least_blocks, int most_blocks = 0);

  /// Time in the current schedule for blocks that are not filled yet, and in the schedule of their
  /// time for others, up to 64 shifts ago.
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
    std::int64_t block;  // first block of this shift
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
  Time grown_at_{};                                         // time when the queue last grew
  // longest delay of each kCalm blocks, the newest first
  std::array<Duration, kRemembered> delays_{};
};

}  // namespace prostm
