#include "mute_watch.hpp"

#include <utility>

#include "prostm/core/stage_timer.hpp"

namespace prostm::app {
namespace {

constexpr double kLook = 0.02;  // [s]

}  // namespace

MuteWatch::MuteWatch(std::shared_ptr<Mute> mute, bool keys) : mute_(std::move(mute)) {
  if (keys) keys_.emplace();
}

std::optional<std::string> MuteWatch::help() const {
  if (!keys_ || !keys_->available()) return std::nullopt;
  return "Keys: m or space mutes the array, and again lets it sound; Ctrl-C ends the run.";
}

std::optional<std::string> MuteWatch::look() {
  const double now = steady_now();
  if (now - looked_ >= kLook) {
    looked_ = now;
    for (char key = 0; keys_ && (key = keys_->next()) != 0;) {
      if (key == 'm' || key == 'M' || key == ' ')
        mute_->set(MuteReason::Person, !mute_->on(MuteReason::Person));
    }
  }
  const auto changed = [this](MuteReason reason, bool& known) {
    const bool before = std::exchange(known, mute_->on(reason));
    return known != before;
  };
  if (changed(MuteReason::Calibration, calibrating_)) {
    return calibrating_ ? "The array is muted for the calibration of the tracker."
                        : "The calibration is over: the array is not muted any more.";
  }
  if (changed(MuteReason::Person, by_person_)) {
    return by_person_ ? "The array is muted." : "The array is not muted any more.";
  }
  if (changed(MuteReason::Hot, hot_)) {
    return hot_ ? "The array is too hot, so it is muted until it has cooled down."
                : "The array has cooled down: it is not muted any more.";
  }
  return std::nullopt;
}

}  // namespace prostm::app
