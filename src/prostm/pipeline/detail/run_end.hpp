#pragma once
/// The end of a run: stop requests and failures. Private to pipeline.

#include <atomic>
#include <exception>
#include <utility>

namespace prostm {

/// Every thread of a run checks it before continuing and reports failures to it, so that no thread
/// waits for one that has ended. All functions are thread-safe.
class RunEnd {
 public:
  /// Asks all threads to end.
  void stop() noexcept { over_.store(true, std::memory_order_release); }
  /// Asks all threads to end because of a failure. Only the first failure is kept.
  void fail(std::exception_ptr failure) noexcept {
    if (!failed_.exchange(true)) failure_ = std::move(failure);
    stop();
  }
  /// Calls f(); an exception ends the run.
  template <class Function>
  void guard(Function&& f) noexcept {
    try {
      f();
    } catch (...) {
      fail(std::current_exception());
    }
  }

  bool over() const noexcept { return over_.load(std::memory_order_acquire); }
  bool failed() const noexcept { return failed_.load(std::memory_order_acquire); }
  /// The first failure; null without one. @pre all other threads of the run have ended.
  const std::exception_ptr& failure() const noexcept { return failure_; }

 private:
  std::atomic<bool> over_{false}, failed_{false};
  std::exception_ptr failure_;  // written by the thread that set failed_
};

}  // namespace prostm
