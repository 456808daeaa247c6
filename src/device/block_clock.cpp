#include "device/block_clock.hpp"

namespace prostm {

BlockClock::BlockClock(Time start, Duration period, int queue_blocks)
    : period_(period), queue_(queue_blocks * period) {
  shifts_.push_back({0, start});
}

BlockClock::Time BlockClock::play_time(std::int64_t block) const {
  std::size_t i = shifts_.size() - 1;
  while (i > 0 && shifts_[i].block > block) --i;
  return shifts_[i].start + block * period_ + queue_;
}

BlockClock::Filled BlockClock::fill(std::int64_t block, Time now) {
  Filled filled;
  filled.late = now > ask_time(block) + period_;
  const Time play = play_time(block);
  if (now <= play) return filled;

  // the queue has run dry: play at the next period's start
  filled.missed = (now - play) / period_ + 1;
  const Time start = shifts_.back().start + filled.missed * period_;
  if (shifts_.size() == kShifts) shifts_.erase(shifts_.begin());
  shifts_.push_back({block, start});
  return filled;
}

}  // namespace prostm
