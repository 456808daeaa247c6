#pragma once
/// Estimates when a device that plays two segments in turn switches between them.

#include <chrono>
#include <cstdint>

namespace prostm {

/// Estimates the times of turns from a device's answers, each of which reports the playing segment.
/// Turns are one period apart on the device's clock, and each lies between two answers: one
/// requested before it, and one received after it. So each turn narrows the interval of possible
/// times, however late the answers are. Has no clock of its own: the caller passes the times.
class TurnClock {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  /// The device's clock may deviate from the host's by 1/kDrift of a period, in either direction.
  static constexpr int kDrift = 5'000;

  void start(Time now, int segment, Duration period);
  /// Takes an answer that was requested at `asked` and received at `now`. @param segment 0 or 1, or
  /// −1 if the answer does not report it.
  void see(Time asked, Time now, int segment);

  int playing() const { return playing_; }       ///< current segment
  std::int64_t turns() const { return turns_; }  ///< turns since start()
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
  Time asked_{};  // request time of the previous answer
  int playing_ = 0;
  std::int64_t turns_ = 0;
};

}  // namespace prostm
