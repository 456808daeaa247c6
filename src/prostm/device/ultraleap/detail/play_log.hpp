#pragma once
/// Play times of a stream's samples, recorded by a callback and readable from any thread.

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace prostm {

/// Log of the newest calls of a device that requests a few samples at a time. One thread adds, any
/// thread reads; nothing locks or allocates. Times are seconds on the steady clock.
class PlayLog {
 public:
  struct Call {
    std::int64_t first = 0;    ///< first sample handed to the device
    std::int64_t samples = 0;  ///< number of samples handed to it
    double play_time = 0.0;    ///< time when `first` leaves the array
    std::int64_t pulled = 0;   ///< first sample pulled from the source
    double time = 0.0;         ///< time of the call
  };

  /// Clears the log. @param rate samples per second. @pre no thread is adding.
  void reset(double rate);
  void add(const Call& call) noexcept;

  /// Time when a sample leaves the array; outside the logged calls, extrapolated by the sample
  /// rate.
  double play_time(std::int64_t sample) const;
  /// Time of the call that pulled a sample from the source.
  double ask_time(std::int64_t sample) const;
  /// Samples that have left the array at `now`.
  std::int64_t played(double now) const;
  std::int64_t calls() const { return calls_.load(std::memory_order_acquire); }
  /// The newest call; all zeros before the first.
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
