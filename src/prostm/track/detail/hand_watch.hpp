#pragma once
/// Removes false hands from a live tracker's frames.

#include <array>
#include <atomic>
#include <cstdint>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Removes hands with a confidence below `least_confidence` from a live tracker's frames, and hands
/// of which no joint has moved for `freeze_time`: every real tracker has noise. Not for hands that
/// may really stand still: recordings, the scripted hand, the page's. Has no clock: times are those
/// of the frames.
class HandWatch {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit HandWatch(const TrackSettings& settings);

  /// Removes these hands from `frame`. One thread; frames in the order of their times.
  void check(HandFrame& frame) noexcept;
  /// Adds the counts of removed hands, and a message about them. Any thread.
  void report(TrackerStatus& status) const;

 private:
  /// Joint positions that a hand has held since a time [s], whatever id the tracker gives it.
  struct Posture {
    double since;
    std::array<Vec3, kJointCount> position;
  };
  std::array<double, 2> still_since(const HandFrame& frame) noexcept;

  const TrackSettings settings_;
  std::array<Posture, 2> postures_;  // postures of the last two hands
  std::atomic<std::int64_t> unsure_{0}, frozen_{0};
  std::atomic<bool> freezes_{false};  // the newest frame had a hand that does not move
};

}  // namespace prostm
