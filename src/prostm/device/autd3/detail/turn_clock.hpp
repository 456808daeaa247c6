#pragma once
/// Times at which a device that plays two segments in turn changes over.

#include <chrono>
#include <cstdint>

namespace prostm {

/// Learns when the turns come from a device's answers, each of which tells the segment that plays.
/// Turns come a period apart by the device's clock, and each lies between two answers: one asked
/// for before it, and one that came after it. So every turn narrows the time in which it can have
/// been, however late the answers are. Has no clock: times come from the caller.
class TurnClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// The device's clock may run slower or faster than the host's by this part of a period.
  static constexpr int kDrift = 5'000;

  void start(Time now, int segment, Duration period);
  /// An answer that was asked for at `asked` and came at `now`. @param segment 0 or 1, or −1 if it
  /// did not tell.
  void see(Time asked, Time now, int segment);

  int playing() const { return playing_; }       ///< segment
  std::int64_t turns() const { return turns_; }  ///< seen since start()
  // earliest and latest time of the last turn, and of the next one
  Time earliest() const { return earliest_; }
  Time latest() const { return latest_; }
  Time next_earliest() const { return earliest_ + period_ - drift(); }
  Time next_latest() const { return latest_ + period_ + drift(); }

 private:
  Duration drift() const { return period_ / kDrift; }
  void skip_two();

  Duration period_{};
  Time earliest_{}, latest_{};
  Time asked_{};  // for the answer before
  int playing_ = 0;
  std::int64_t turns_ = 0;
};

}  // namespace prostm
