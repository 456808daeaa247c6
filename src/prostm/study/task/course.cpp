#include "prostm/study/task/course.hpp"

#include <utility>

#include "prostm/study/task/task.hpp"

namespace prostm {

Course::Course(const Protocol& protocol, int participant)
    : protocol_(&protocol),
      participant_(participant),
      turns_(random_for(protocol, Purpose::Tracks, static_cast<std::uint32_t>(participant))) {
  const Task& task = *protocol.trials.task;
  if (!task.traits().has_levels) {
    list_ = task.trials(protocol, participant);
    most_ = list_.size();
    trial_ = list_.front();
    return;
  }
  const TrackPlan plan = task.tracks(protocol);
  open_ = plan.open;
  methods_ = method_order(protocol, participant);
  Random seeds = random_for(protocol, Purpose::Intervals, static_cast<std::uint32_t>(participant));
  for (const int method : methods_) {
    for (int scene = 0; scene < static_cast<int>(protocol.scenes.size()); ++scene) {
      for (int i = 0; i < plan.tracks; ++i) {
        const std::uint64_t seed = seeds.bits();
        lanes_.push_back({method, scene, Track(protocol, seed), Random(seeds.bits())});
        most_ += lanes_.back().track.most();
      }
    }
  }
  next_lane();
}

/// Moves to the next track, or to the next method if all tracks of this one are done.
void Course::next_lane() {
  const auto is_open = [&](std::size_t i) {
    return lanes_[i].method == methods_[method_] && !lanes_[i].track.is_done();
  };
  while (!round_.empty() && !is_open(round_.back())) round_.pop_back();
  for (; round_.empty() && method_ < methods_.size(); method_ += round_.empty() ? 1 : 0) {
    for (std::size_t i = 0; i < lanes_.size(); ++i)
      if (is_open(i)) round_.push_back(i);
    turns_.shuffle(round_);
  }
  if (round_.empty()) return;
  const std::size_t place = round_.back();
  round_.pop_back();
  Lane& l = lanes_[place];
  trial_ = {.method = l.method,
            .scene = l.scene,
            .question = l.scene,
            .track = static_cast<int>(place) + 1,
            .level = l.track.level(),
            .level_at = protocol_->trials.task->draw_interval(l.intervals)};
}

bool Course::is_done() const {
  if (lanes_.empty()) return given_.size() == list_.size();
  return method_ == methods_.size();
}

/// Advances after an answer.
void Course::step() {
  const int before = trial_.method;
  if (!lanes_.empty()) {
    next_lane();
  } else if (!is_done()) {
    trial_ = list_[given_.size()];
  }
  starts_method_ = trial_.method != before;
}

void Course::answer(bool felt) {
  if (!lanes_.empty()) lane().track.answer(felt);
  given_.push_back(felt);
  step();
}

bool Course::correct() {
  if (lanes_.empty()) {
    given_.back() = !given_.back();
    return true;
  }
  Course other(*protocol_, participant_);
  for (std::size_t i = 0; i < given_.size(); ++i)
    other.answer(given_[i] == (i + 1 < given_.size()));
  if (other.is_done() != is_done()) return false;
  if (!is_done() && other.trial().method != trial().method) return false;
  *this = std::move(other);
  return true;
}

void Course::tune(int steps, bool coarse) {
  lane().track.tune(steps, coarse);
  trial_.level = lane().track.level();
}

void Course::accept(double level) {
  lane().track.accept(level);
  given_.push_back(true);
  step();
}

double Course::result(int track) const {
  return lanes_[static_cast<std::size_t>(track - 1)].track.result();
}

}  // namespace prostm
