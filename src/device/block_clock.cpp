#include "device/block_clock.hpp"

namespace prostm {

BlockClock::BlockClock(Time start, Duration period, int queue_blocks, int most_blocks)
    : period_(period),
      least_(queue_blocks * period),
      most_(std::max(queue_blocks, most_blocks) * period) {
  shifts_.push_back({0, start, least_});
}

const BlockClock::Shift& BlockClock::shift_of(std::int64_t block) const {
  std::size_t i = shifts_.size() - 1;
  while (i > 0 && shifts_[i].block > block) --i;
  return shifts_[i];
}

BlockClock::Time BlockClock::ask_time(std::int64_t block) const {
  return shift_of(block).start + block * period_;
}

BlockClock::Time BlockClock::play_time(std::int64_t block) const {
  const Shift& s = shift_of(block);
  return s.start + block * period_ + s.queue;
}

BlockClock::Filled BlockClock::fill(std::int64_t block, Time now) {
  Filled filled;
  // blocks that a longer queue asks for at once are asked for when it grew
  const Duration delay = now - std::max(ask_time(block), grown_at_);
  filled.late = delay > period_;
  const Time play = play_time(block);
  if (now <= play) {
    watch(block, delay, now);
    return filled;
  }

  // the queue has run dry: play at the next period's start
  filled.missed = (now - play) / period_ + 1;
  const Duration missed = filled.missed * period_,
                 longer = std::min(missed, most_ - shifts_.back().queue);
  shift(block, missed - longer, longer);
  watched_since_ = block;
  longest_delay_ = {};
  return filled;
}

/// From `block` on, blocks are asked for later and wait longer.
void BlockClock::shift(std::int64_t block, Duration later, Duration longer) {
  const Shift last = shifts_.back();
  if (shifts_.size() == kShifts) shifts_.erase(shifts_.begin());
  shifts_.push_back({block, last.start + later, last.queue + longer});
}

/// One period more than those that a delay reaches into.
BlockClock::Duration BlockClock::needed(Duration delay) const {
  return std::clamp((delay / period_ + 2) * period_, least_, most_);
}

/// Lengthens a queue that was nearly dry, and shortens one that was longer than needed for a while.
void BlockClock::watch(std::int64_t block, Duration delay, Time now) {
  longest_delay_ = std::max(longest_delay_, delay);
  const Duration spare = shifts_.back().queue - needed(longest_delay_);
  if (spare < Duration::zero()) {
    shift(block + 1, spare, -spare);
    grown_at_ = now;
  }
  if (block - watched_since_ < kCalm) return;
  if (spare > Duration::zero()) shift(block + 1, spare, -spare);
  watched_since_ = block;
  longest_delay_ = {};
}

}  // namespace prostm
