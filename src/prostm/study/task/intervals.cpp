#include "prostm/study/task/intervals.hpp"

namespace prostm {

bool Intervals::begins_with_level(const Protocol& protocol, const Trial& trial) {
  if (protocol.trials.task == StudyTask::ForcedChoice) return trial.level_first;
  return protocol.trials.task != StudyTask::Adjustment;
}

void Intervals::begin(const Protocol& protocol, const Trial& trial, double time) {
  task_ = protocol.trials.task;
  const bool identifies = task_ == StudyTask::Identification;
  several_ = task_ == StudyTask::ForcedChoice || task_ == StudyTask::Adjustment;
  length_ = identifies ? protocol.trials.time_limit : protocol.level.interval;
  gap_ = protocol.level.gap;
  needed_ = several_ ? 2 : 1;
  number_ = 1;
  shows_level_ = begins_with_level(protocol, trial);
  sounds_ = true;
  over_ = false;
  since_ = asked_at_ = time;
}

void Intervals::look(double time, bool in_force) {
  if (over_) return;
  if (sounds_) {
    if (!(length_ > 0.0) || time - since_ < length_) return;
    sounds_ = false;
    since_ = time;
    over_ = !several_ || (task_ == StudyTask::ForcedChoice && number_ == needed_);
    if (!over_) shows_level_ = !shows_level_;
    return;
  }
  if (time - since_ < gap_ || !in_force) return;
  sounds_ = true;
  since_ = time;
  ++number_;
  if (number_ == needed_) asked_at_ = time;
}

}  // namespace prostm
