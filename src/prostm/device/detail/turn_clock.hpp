#pragma once
/// Times at which a device that plays two segments in turn changes over.

#include <chrono>
#include <cstdint>

namespace prostm {

/// Learns when the turns come from a device's answers, each of which tells the segment that plays.
/// An answer comes some time after the turn, never before it, and turns come a period apart by the
/// device's clock: so the earliest answers count, and the estimate drifts with them. Has no clock:
/// times come from the caller.
class TurnClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// The device's clock may run slower than the host's by this much of a period.
  static constexpr int kDrift = 5'000;

  void start(Time now, int segment, Duration period);
  /// An answer that came in at `now`. @param segment 0 or 1, or −1 if it did not tell.
  void see(Time now, int segment);

  int playing() const { return playing_; }       ///< segment
  std::int64_t turns() const { return turns_; }  ///< seen since start()
  Time last_turn() const { return last_; }
  Time next_turn() const { return last_ + period_; }

 private:
  Duration period_{};
  Time last_{};
  int playing_ = 0;
  std::int64_t turns_ = 0;
};

}  // namespace prostm
