#pragma once
/// How well what is felt renders its target, while somebody looks: on a thread of its own, of the
/// lowest priority, now and then.

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

  /// Takes a copy of the plan when the last one was taken long enough ago, and otherwise nothing.
  /// @param patch that is judged. @pre the plan is planned.
  void offer(const PlanSnapshot& plan, int patch);
  /// felt_skill() of the last plan that was judged; NaN before the first.
  double skill() const { return skill_.load(std::memory_order_relaxed); }

 private:
  void work(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  PlanSnapshot plan_;  // under the mutex, until the thread takes it
  int patch_ = 0;
  bool waiting_ = false;
  std::chrono::steady_clock::time_point next_{};
  std::atomic<double> skill_{std::numeric_limits<double>::quiet_NaN()};
  std::jthread thread_;
};

}  // namespace prostm::viewer
