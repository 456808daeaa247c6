#pragma once
/// The one owner of a run's end. Private to pipeline.

#include <atomic>
#include <exception>
#include <utility>

namespace prostm {

/// Every thread of a run asks it whether to go on, and tells it what fails: so that no thread waits
/// for one that has ended. Any thread may call any function.
class RunEnd {
 public:
  /// Asks all threads to end.
  void stop() noexcept { over_.store(true, std::memory_order_release); }
  /// The same because something failed. Of several failures the first counts.
  void fail(std::exception_ptr failure) noexcept {
    if (!failed_.exchange(true)) failure_ = std::move(failure);
    stop();
  }
  /// Calls f(); what it throws ends the run.
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
  /// The first failure; null without one. @pre no other thread of the run is there any more.
  const std::exception_ptr& failure() const noexcept { return failure_; }

 private:
  std::atomic<bool> over_{false}, failed_{false};
  std::exception_ptr failure_;  // of the thread that set failed_
};

}  // namespace prostm
