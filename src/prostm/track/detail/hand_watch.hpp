#pragma once
/// Tells a live tracker's hands from what only looks like them.

#include <array>
#include <atomic>
#include <cstdint>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Leaves hands out of a live tracker's frames: those below `least_confidence`, and those none of
/// whose joints has moved for `freeze_time`, since no real tracker is without noise. Not for hands
/// that may stand still in truth: recordings, the scripted hand, the page's. Has no clock: times
/// are those of the frames.
class HandWatch {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit HandWatch(const TrackSettings& settings);

  /// Takes out of `frame` what is not to be taken. One thread; frames in the order of their times.
  void check(HandFrame& frame) noexcept;
  /// Adds what was left out so far, and says so. Any thread.
  void report(TrackerStatus& status) const;

 private:
  /// Where the joints of a hand have been since a time [s], whatever id the tracker gives it.
  struct Posture {
    double since;
    std::array<Vec3, kJointCount> position;
  };
  std::array<double, 2> still_since(const HandFrame& frame) noexcept;

  const TrackSettings settings_;
  std::array<Posture, 2> postures_;  // of the last two hands
  std::atomic<std::int64_t> unsure_{0}, frozen_{0};
  std::atomic<bool> freezes_{false};  // the newest frame had a hand that does not move
};

}  // namespace prostm
