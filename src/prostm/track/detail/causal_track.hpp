#pragma once
/// Hands at the present moment, computed from a live tracker's past frames only.

#include <array>
#include <cstddef>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Up to two hands from tracker frames that come in at irregular times. A joint's velocity is the
/// slope of the least-squares line through the frames of the last `smoothing_time`, (H17) of
/// docs/design/hands.md. With `prediction`, its position is extrapolated from the newest frame with
/// that velocity over the frame's age plus `prediction`, (H18), by at most `prediction_limit`.
/// Orientations and radii are the newest ones. Has no clock and no thread: times come from the
/// caller.
class CausalTrack {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit CausalTrack(const TrackSettings& settings);

  /// Adds a frame; its velocities are not used. Returns false and changes nothing unless
  /// `frame.time` is later than that of the last frame. Allocates nothing.
  /// @pre finite joints; two hands differ in id or side.
  bool add(const HandFrame& frame) noexcept;

  /// Sets `out` to the hands at `time` [s], not before that of the newest frame. A hand missing
  /// from the frames for longer than `max_gap` is gone. Sets `age` to `time` less the newest
  /// frame's time, or to 0 before the first frame. Allocates nothing.
  void sample(double time, HandFrame& out) const noexcept;

  /// Forgets all frames.
  void clear() noexcept;

 private:
  static constexpr std::size_t kFrames = 64;  // past frames: 0.5 s at 120 Hz

  /// A ring buffer of one hand's frames: the newest is at `newest`, older ones precede it.
  struct Track {
    std::size_t count = 0, newest = 0;
    std::array<double, kFrames> times;  // [s]
    std::array<std::array<Vec3, kJointCount>, kFrames> positions;
    Hand hand;  // the newest, with velocities by (H17)

    double last_time() const { return times[newest]; }
  };
  Track& track_of(const HandFrame& frame, const Hand& hand) noexcept;
  void append(Track& track, double time, const Hand& hand) const noexcept;
  void set_velocities(Track& track) const noexcept;

  TrackSettings settings_;
  double newest_time_ = 0.0;  // over all frames [s]
  bool any_ = false;
  std::array<Track, 2> tracks_;
};

}  // namespace prostm
