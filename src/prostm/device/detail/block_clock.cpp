#include "prostm/device/detail/block_clock.hpp"

namespace prostm {

BlockClock::BlockClock(Time start, Duration period, int least_blocks, int most_blocks)
    : period_(period),
      least_(least_blocks * period),
      most_(std::max(least_blocks, most_blocks) * period) {
  shifts_.push_back({0, start, most_});
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
  // blocks that are requested early because the queue grew count as requested at that moment
  const Duration delay = now - std::max(ask_time(block), grown_at_);
  filled.late = delay > period_;
  delays_.front() = std::max(delays_.front(), delay);
  const Time play = play_time(block);
  if (now <= play) {
    lengthen(block, delay, now);
  } else {
    // the queue has run empty: play at the start of the next period
    filled.missed = (now - play) / period_ + 1;
    const Duration missed = filled.missed * period_,
                   longer = std::min(missed, most_ - shifts_.back().queue);
    shift(block, missed - longer, longer);
  }
  if ((block + 1) % kCalm == 0) shorten(block);
  return filled;
}

/// From `block` on, requests blocks later and keeps them in the queue for longer.
void BlockClock::shift(std::int64_t block, Duration later, Duration longer) {
  const Shift last = shifts_.back();
  if (shifts_.size() == kShifts) shifts_.erase(shifts_.begin());
  shifts_.push_back({block, last.start + later, last.queue + longer});
}

/// Returns the queue needed for a delay: the periods that the delay reaches into, plus one.
BlockClock::Duration BlockClock::needed(Duration delay) const {
  return std::clamp((delay / period_ + 2) * period_, least_, most_);
}

/// Lengthens a queue that was nearly empty.
void BlockClock::lengthen(std::int64_t block, Duration delay, Time now) {
  const Duration lacks = needed(delay) - shifts_.back().queue;
  if (lacks <= Duration::zero()) return;
  shift(block + 1, -lacks, lacks);
  grown_at_ = now;
}

/// Shortens the queue by one period if a shorter one was enough for all remembered blocks.
void BlockClock::shorten(std::int64_t block) {
  const Duration longest = *std::max_element(delays_.begin(), delays_.end());
  if (shifts_.back().queue > needed(longest)) shift(block + 1, period_, -period_);
  std::shift_right(delays_.begin(), delays_.end(), 1);
  delays_.front() = {};
}

}  // namespace prostm
