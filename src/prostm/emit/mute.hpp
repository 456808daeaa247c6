#pragma once
/// Silence requested from outside, whatever is planned.

#include <atomic>
#include <cstdint>

namespace prostm {

/// Reason for silencing the output.
enum class MuteReason : std::uint32_t {
  Calibration = 1U,  ///< a finger is going to touch the transducers
  NoHand = 2U,       ///< the last step of a run in real time found no hand
  Person = 4U,       ///< a person muted it, on the terminal or a page
  Hot = 8U,          ///< the device reports that it is too hot
  Ended = 16U,       ///< the run was stopped or failed
  Study = 32U        ///< a study is presenting nothing
};

/// Reasons for silence: any thread may set them, and an emitter obeys at its next block. Lock-free.
/// A thread that sees a reason set or cleared also sees everything written before set() was called.
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
  /// Whether it is on for any other reason than this one.
  bool on_besides(MuteReason reason) const noexcept {
    return (reasons_.load(std::memory_order_acquire) & ~static_cast<std::uint32_t>(reason)) != 0;
  }

 private:
  std::atomic<std::uint32_t> reasons_{0};
};

}  // namespace prostm
