#include "prostm/device/detail/turn_clock.hpp"

#include <algorithm>

namespace prostm {

void TurnClock::start(Time now, int segment, Duration period) {
  *this = {};
  period_ = period;
  last_ = now;
  playing_ = segment;
}

void TurnClock::see(Time now, int segment) {
  if (segment < 0) return;
  // two turns that no answer told of lead back to the same segment
  const Duration unseen = 2 * period_ + period_ / 4;
  if (turns_ > 0) {
    while (now - last_ > unseen) {
      last_ += 2 * period_;
      turns_ += 2;
    }
  }
  if (segment == playing_) return;
  const Time expected = next_turn() + period_ / kDrift;
  // the first turn, or one that does not fit, tells the time by itself
  const bool fits = turns_ > 0 && now > expected - period_ / 4 && now < expected + period_;
  last_ = fits ? std::min(now, expected) : now;
  playing_ = segment;
  ++turns_;
}

}  // namespace prostm
