#include "prostm/device/autd3/detail/turn_clock.hpp"

#include <algorithm>

namespace prostm {

void TurnClock::start(Time now, int segment, Duration period) {
  *this = {};
  period_ = period;
  earliest_ = latest_ = asked_ = now;
  playing_ = segment;
}

/// Counts two turns that no answer reported: they lead back to the same segment.
void TurnClock::skip_two() {
  earliest_ += 2 * (period_ - drift());
  latest_ += 2 * (period_ + drift());
  turns_ += 2;
}

void TurnClock::see(Time asked, Time now, int segment) {
  if (segment < 0) return;
  if (segment == playing_) {
    while (turns_ > 0 && asked > latest_ + 2 * (period_ + drift())) skip_two();
    asked_ = asked;
    return;
  }
  while (turns_ > 0 && asked > latest_ + 3 * (period_ + drift())) skip_two();
  const Time after = asked_, before = now;
  Time earliest = after, latest = before;
  if (turns_ > 0) {
    earliest = std::max(after, next_earliest());
    latest = std::min(before, next_latest());
  }
  // the prediction does not fit: use the answers around this turn alone
  if (earliest > latest) {
    earliest = after;
    latest = before;
  }
  earliest_ = earliest;
  latest_ = latest;
  asked_ = asked;
  playing_ = segment;
  ++turns_;
}

}  // namespace prostm
