#pragma once
/// Silence that is asked for from outside, whatever is planned.

#include <atomic>
#include <cstdint>

namespace prostm {

/// Why the output is to be silent.
enum class MuteReason : std::uint32_t {
  Calibration = 1U,  ///< a finger is going to touch the transducers
  NoHand = 2U        ///< the last step of a run in real time found no hand
};

/// Asked for by any thread, obeyed by an emitter at its next block. Nobody waits.
class Mute {
 public:
  void set(MuteReason reason, bool on) noexcept {
    const auto bit = static_cast<std::uint32_t>(reason);
    if (on) {
      reasons_.fetch_or(bit, std::memory_order_relaxed);
    } else {
      reasons_.fetch_and(~bit, std::memory_order_relaxed);
    }
  }
  /// For any reason.
  bool on() const noexcept { return reasons_.load(std::memory_order_relaxed) != 0; }
  bool on(MuteReason reason) const noexcept {
    return (reasons_.load(std::memory_order_relaxed) & static_cast<std::uint32_t>(reason)) != 0;
  }

 private:
  std::atomic<std::uint32_t> reasons_{0};
};

}  // namespace prostm
