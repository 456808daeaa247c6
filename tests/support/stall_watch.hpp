#pragma once
/// Time that a test was held up by the machine.

#include <atomic>
#include <chrono>
#include <thread>

namespace prostm::test {

/// Measures how long this process was held up, by a thread that sleeps for 5 ms at a time. Times of
/// what was observed, less this, do not depend on other processes.
class StallWatch {
 public:
  /// Sum of what was slept too long, of sleeps of more than 25 ms, since construction [s].
  double held_up() const { return held_up_.load(); }

 private:
  using Clock = std::chrono::steady_clock;
  void watch(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      const auto before = Clock::now();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      const double slept = std::chrono::duration<double>(Clock::now() - before).count();
      if (slept > 0.025) held_up_ = held_up_ + slept - 0.005;
    }
  }

  std::atomic<double> held_up_{0.0};
  std::jthread thread_{[this](const std::stop_token& stop) { watch(stop); }};
};

}  // namespace prostm::test
