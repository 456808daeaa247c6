#pragma once
/// Times of a stream's samples, told by a callback and asked for by any thread.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace prostm {

/// Remembers the newest calls of a device that asks for some samples at a time. One thread adds,
/// any thread asks; nothing locks or allocates. Times are seconds of the steady clock.
class PlayLog {
 public:
  struct Call {
    std::int64_t first = 0;    ///< sample that was given first
    std::int64_t samples = 0;  ///< number that was given
    double play_time = 0.0;    ///< when `first` leaves the array
    std::int64_t pulled = 0;   ///< sample that was taken first from the source
    double time = 0.0;         ///< of the call
  };

  /// Forgets all calls. @param rate samples a second. @pre nothing adds.
  void reset(double rate);
  void add(const Call& call) noexcept;

  /// Time when a sample leaves the array; beyond the remembered calls by the sample rate.
  double play_time(std::int64_t sample) const;
  /// Time of the call that took a sample from its source.
  double ask_time(std::int64_t sample) const;
  /// Samples that have left the array at `now`.
  std::int64_t played(double now) const;
  std::int64_t calls() const { return calls_.load(std::memory_order_acquire); }
  /// The newest call; zeros before the first.
  Call newest() const;

 private:
  static constexpr std::size_t kCalls = 2048;  // 2 s at 1000 a second
  struct Slot {
    std::atomic<std::int64_t> first{0}, samples{0}, pulled{0};
    std::atomic<double> play_time{0.0}, time{0.0};
  };
  bool read(std::int64_t call, Call& out) const;
  template <class Is>
  bool find(Is&& is_it, Call& out) const;

  std::array<Slot, kCalls> slots_;
  std::atomic<std::int64_t> calls_{0};
  std::atomic<double> rate_{1.0};
};

}  // namespace prostm
