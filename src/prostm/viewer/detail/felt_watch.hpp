#pragma once
/// Regularly evaluates how well the felt stimulus renders its target, while there are viewers. Uses
/// a thread of the lowest priority.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <thread>

#include "prostm/pipeline/snapshot.hpp"

namespace prostm::viewer {

class FeltWatch {
 public:
  FeltWatch();

  /// Copies the plan for evaluation if the last copy is old enough; otherwise does nothing. @param
  /// patch the patch to evaluate. @pre plan.planned.
  void offer(const PlanSnapshot& plan, int patch);
  /// felt_skill() of the last evaluated plan; NaN before the first.
  double skill() const { return skill_.load(std::memory_order_relaxed); }

 private:
  void work(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  PlanSnapshot plan_;  // guarded by the mutex, until the thread takes it
  int patch_ = 0;
  bool waiting_ = false;
  std::chrono::steady_clock::time_point next_{};
  std::atomic<double> skill_{std::numeric_limits<double>::quiet_NaN()};
  std::jthread thread_;
};

}  // namespace prostm::viewer
