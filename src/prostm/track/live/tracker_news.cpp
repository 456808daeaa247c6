#include "prostm/track/live/tracker_news.hpp"

#include <fmt/format.h>

namespace prostm {
namespace {

constexpr double kFirstTry = 1.5;  // time for a first attempt to connect [s]
constexpr double kSilence = 2.0;   // without a frame, a connected tracker counts as silent [s]
constexpr double kQuiet = 5.0;     // least time between messages after the first connection [s]

}  // namespace

TrackerNews::State TrackerNews::state_of(const TrackerStatus& status, double time) {
  if (status.connected && !connected_) connected_since_ = time;
  connected_ = status.connected;
  was_connected_ = was_connected_ || connected_;
  if (connected_) {
    const bool is_silent = status.frames == 0 && time - connected_since_ >= kSilence;
    return is_silent ? State::Silent : State::Connected;
  }
  if (was_connected_) return State::Lost;
  return time >= kFirstTry ? State::Missing : State::Unknown;
}

const char* TrackerNews::news_of_connection(State before) {
  if (before == State::Lost) return "is back";
  return before == State::Silent ? "sends frames now" : "is there";
}

std::optional<std::string> TrackerNews::look(const TrackerStatus& status, double time) {
  const State state = state_of(status, time), before = told_;
  if (state == before || state == State::Unknown) return {};
  const bool first = before == State::Unknown || before == State::Missing;
  if (!first && time - told_at_ < kQuiet) return {};
  told_ = state;
  told_at_ = time;
  switch (state) {
    case State::Missing:
      return fmt::format(
          "No tracker yet: {}. The run continues without a hand and keeps trying to connect.",
          status.sentence);
    case State::Silent:
      return fmt::format("The tracker sends no frame: {}. Is it plugged in?", status.sentence);
    case State::Lost:
      return fmt::format("The tracker is lost: {}.", status.sentence);
    default:
      return fmt::format("The tracker {}: {}.", news_of_connection(before), status.sentence);
  }
}

}  // namespace prostm
