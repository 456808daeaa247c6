#pragma once
/// The clock of all stages: the current time, and the duration of work.

#include <algorithm>
#include <chrono>

namespace prostm {

/// Time of the steady clock [s].
inline double steady_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Runs from construction or restart(). Monotonic.
class StageTimer {
 public:
  void restart() { start_ = std::chrono::steady_clock::now(); }
  /// Seconds since the start.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Returns the seconds since the start and restarts.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double t = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return t;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns a running mean of durations, updated by one. A duration may include an interruption, so
/// it is clamped to 0.5 to 2 times the mean.
inline double updated_mean(double mean, double duration) {
  constexpr double kLearning = 0.2;
  return mean + kLearning * (std::clamp(duration, 0.5 * mean, 2.0 * mean) - mean);
}

/// A time on a timer; without a timer it never passes.
struct Deadline {
  const StageTimer* timer = nullptr;
  double at = 0.0;  ///< [s]
  bool has_passed() const { return timer != nullptr && timer->seconds() >= at; }
};

}  // namespace prostm
