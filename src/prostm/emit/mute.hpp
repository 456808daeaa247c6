#pragma once
/// Silence requested from outside, whatever is planned.

#include <atomic>
#include <cstdint>

namespace prostm {

/// Reason for silencing the output.
enum class MuteReason : std::uint32_t {
  Calibration = 1U,  ///< a finger is going to touch the transducers
  NoHand = 2U,       ///< the last step of a run in real time found no hand
  Person = 4U,       ///< somebody who looks at the run asked for silence
  Hot = 8U,          ///< the device says that it is too hot
  Ended = 16U,       ///< the run was stopped, or something in it failed
  Study = 32U        ///< a study presents nothing now
};

/// Set by any thread, obeyed by an emitter at its next block. Nobody waits. Whoever finds it as
/// set() left it also finds what was written before.
class Mute {
 public:
  void set(MuteReason reason, bool on) noexcept {
    const auto bit = static_cast<std::uint32_t>(reason);
    if (on) {
      reasons_.fetch_or(bit, std::memory_order_release);
    } else {
      reasons_.fetch_and(~bit, std::memory_order_release);
    }
  }
  /// Whether it is on for any reason.
  bool on() const noexcept { return reasons_.load(std::memory_order_acquire) != 0; }
  bool on(MuteReason reason) const noexcept {
    return (reasons_.load(std::memory_order_acquire) & static_cast<std::uint32_t>(reason)) != 0;
  }

 private:
  std::atomic<std::uint32_t> reasons_{0};
};

}  // namespace prostm
