#include "chain.hpp"

namespace standin {

bool Chain::refuses(int current, int segment, int rep, int mode) {
  if (mode == kNone) return false;
  const bool for_endless = mode == kImmediate || mode == kExt;
  const bool for_finite = mode == kSyncIdx || mode == kSysTime || mode == kGpio;
  if (!for_endless && !for_finite) return true;
  if (segment == current) return for_finite;
  return rep == kEndless ? for_finite : for_endless;
}

void Chain::set(int segment, const Shape& shape, int mode, std::uint64_t value, std::int64_t tick) {
  // counted with the length and rate that the segment had before, like the firmware
  const std::int64_t lap_before = lap(segment, tick);
  shape_[static_cast<std::size_t>(segment)] = shape;
  mode_ = mode;
  value_ = value;
  if (segment == segment_ || shape.rep == kEndless) {
    segment_ = segment;
    alternates_ = mode == kExt;
    alternated_lap_ = lap_before;
    begin_ = 0;
    state_ = State::Endless;
  } else {
    wanted_ = segment;
    set_lap_ = lap(segment, tick);
    state_ = State::Waits;
  }
}

bool Chain::starts(std::int64_t tick, int gpio, std::uint64_t now) const {
  if (mode_ == kSyncIdx) return lap(wanted_, tick) > set_lap_;
  if (mode_ == kSysTime) return now >= value_;
  return (gpio >> value_ & 1) != 0;
}

void Chain::go_to(std::int64_t tick, int gpio, std::uint64_t now) {
  if (state_ == State::Waits && starts(tick, gpio, now)) {
    state_ = State::Finite;
    segment_ = wanted_;
    alternates_ = false;
    // in phase with the segment's laps, or from this sample on
    const std::int64_t sample = tick / shape().divider;
    begin_ = mode_ == kSyncIdx ? sample - sample % shape().cycle : sample;
  }
  if (state_ == State::Endless && alternates_) {
    // both segments count the laps of the one that was set to alternate
    const std::int64_t now_lap = lap(segment_, tick);
    if (now_lap > alternated_lap_) {
      const bool odd = (now_lap - alternated_lap_) % 2 != 0;
      alternated_lap_ = now_lap;
      if (odd) segment_ = 1 - segment_;
    }
  }
  const std::int64_t sample = tick / shape().divider;
  if (state_ == State::Finite) {
    const std::int64_t played = sample - begin_;
    const bool over = played >= (std::int64_t{shape().rep} + 1) * shape().cycle;
    index_ = over ? shape().cycle - 1 : played % shape().cycle;  // the last one is held
  } else if (state_ == State::Endless) {
    index_ = sample % shape().cycle;
  }
}

}  // namespace standin
