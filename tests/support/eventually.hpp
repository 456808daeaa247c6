#pragma once
/// Waits for another thread.

#include <chrono>
#include <thread>

namespace prostm::test {

/// Waits until `done()`; returns false after a time that only a failure takes.
template <class Condition>
bool eventually(Condition&& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace prostm::test
