#pragma once
/// The clock of all stages: the current time, and the duration of work.

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

/// A time on a timer; without a timer it never passes.
struct Deadline {
  const StageTimer* timer = nullptr;
  double at = 0.0;  ///< [s]
  bool has_passed() const { return timer != nullptr && timer->seconds() >= at; }
};

}  // namespace prostm
