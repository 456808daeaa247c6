#include "prostm/viewer/detail/command_queue.hpp"

#include <algorithm>

namespace prostm::viewer {
namespace {

constexpr std::size_t kMostWaiting = 64;
constexpr std::chrono::milliseconds kRuns{50};     // time between an answer and the next commands
constexpr std::chrono::seconds kLongestAnswer{1};  // a run that has not begun does not answer

/// Whether a command makes an older one obsolete.
bool replaces(const LiveCommand& newer, const LiveCommand& older) {
  using Kind = LiveCommand::Kind;
  const auto plays = [](Kind kind) { return kind == Kind::Play || kind == Kind::Pause; };
  if (plays(newer.kind) && plays(older.kind)) return true;
  if (newer.kind != older.kind || newer.kind == Kind::Step) return false;
  return newer.kind != Kind::Set || newer.control == older.control;
}

}  // namespace

bool CommandQueue::add(const LiveCommand& command, Clock::time_point now) {
  std::erase_if(waiting_, [&](const LiveCommand& older) { return replaces(command, older); });
  if (waiting_.size() >= kMostWaiting) return false;
  waiting_.push_back(command);
  hand_over(now);
  return true;
}

void CommandQueue::answered(Clock::time_point now) {
  if (!asked_) return;
  asked_ = false;
  next_ = now + kRuns;
}

void CommandQueue::hand_over(Clock::time_point now) {
  if (waiting_.empty() || now < next_) return;
  const auto refused = std::find_if_not(waiting_.begin(), waiting_.end(),
                                        [&](const auto& command) { return control_.ask(command); });
  waiting_.erase(waiting_.begin(), refused);
  asked_ = true;
  next_ = now + kLongestAnswer;
}

}  // namespace prostm::viewer
