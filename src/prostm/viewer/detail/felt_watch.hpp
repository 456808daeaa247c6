#pragma once
/// Regularly evaluates how well and how strongly the stimulus is felt, while there are viewers.
/// Uses a thread of the lowest priority.

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "prostm/pipeline/snapshot.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::viewer {

class FeltWatch {
 public:
  FeltWatch();

  /// Copies the plan for evaluation if the last copy is old enough; otherwise does nothing. @param
  /// patch the patch to evaluate. @pre plan.planned.
  void offer(const PlanSnapshot& plan, int patch);
  /// plan_percept() of the last evaluated plan; NaN before the first.
  PlanPercept percept() const {
    const std::scoped_lock lock(mutex_);
    return percept_;
  }

 private:
  void work(const std::stop_token& stop);

  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  PlanSnapshot plan_;  // guarded by the mutex, until the thread takes it
  int patch_ = 0;
  bool waiting_ = false;
  PlanPercept percept_;  // guarded by the mutex
  std::chrono::steady_clock::time_point next_{};
  std::jthread thread_;
};

}  // namespace prostm::viewer
