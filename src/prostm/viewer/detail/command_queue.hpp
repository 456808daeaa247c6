#pragma once
/// The queue of commands from the pages to a run. Private to viewer.

#include <chrono>
#include <vector>

#include "prostm/pipeline/live.hpp"

namespace prostm::viewer {

/// A run pauses while it applies new settings. So commands are passed on only after the run has
/// answered the previous ones and has then run for a while; meanwhile, a newer value replaces an
/// older one of the same control.
class CommandQueue {
 public:
  using Clock = std::chrono::steady_clock;
  explicit CommandQueue(LiveControl& control) : control_(control) {}

  /// Adds a command; false if the queue is full.
  bool add(const LiveCommand& command, Clock::time_point now);
  /// Records that the run has answered.
  void answered(Clock::time_point now);
  /// Passes all pending commands to the run, if it is time.
  void hand_over(Clock::time_point now);

 private:
  LiveControl& control_;
  std::vector<LiveCommand> waiting_;
  bool asked_ = false;  // commands were passed on, and not answered yet
  Clock::time_point next_{};
};

}  // namespace prostm::viewer
