#include "prostm/study/task/intervals.hpp"

namespace prostm {

void Intervals::begin(const IntervalPlan& plan, double time) {
  plan_ = plan;
  place_ = 0;
  begun_ = 1;
  playing_ = true;
  over_ = false;
  since_ = asked_at_ = time;
}

void Intervals::look(double time, bool in_force) {
  if (over_) return;
  const std::size_t count = plan_.shows_level.size();
  if (playing_) {
    if (!(plan_.length > 0.0) || time - since_ < plan_.length) return;
    playing_ = false;
    since_ = time;
    over_ = !several() || (!plan_.in_turn && begun_ == count);
    if (!over_) place_ = (place_ + 1) % count;
    return;
  }
  if (time - since_ < plan_.gap || !in_force) return;
  playing_ = true;
  since_ = time;
  ++begun_;
  if (begun_ == count) asked_at_ = time;
}

}  // namespace prostm
