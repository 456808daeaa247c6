#pragma once
/// The queue of commands from the pages to a run. Private to viewer.

#include <chrono>
#include <vector>

#include "prostm/pipeline/live.hpp"

namespace prostm::viewer {

/// A run stands while it takes new settings. So it is asked once it has answered what was asked
/// before and has then run for a while; of what comes in between, a newer value replaces an older
/// one of the same control.
class CommandQueue {
 public:
  using Clock = std::chrono::steady_clock;
  explicit CommandQueue(LiveControl& control) : control_(control) {}

  /// False when too many commands wait.
  bool add(const LiveCommand& command, Clock::time_point now);
  /// The run has answered.
  void answered(Clock::time_point now);
  /// Asks the run for everything that waits, if it is time to.
  void hand_over(Clock::time_point now);

 private:
  LiveControl& control_;
  std::vector<LiveCommand> waiting_;
  bool asked_ = false;  // and not answered yet
  Clock::time_point next_{};
};

}  // namespace prostm::viewer
