#pragma once
/// What a live tracker's frames tell about now: hands from past frames alone.

#include <array>
#include <cstddef>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Up to two hands from tracker frames that come in at irregular times. A joint's velocity is the
/// slope of the least-squares line through the frames of the last `smoothing_time`, (H17) of
/// docs/design.md; with `prediction` its position runs ahead of the newest frame with that velocity
/// over the frame's age and `prediction`, (H18), at most `prediction_limit` far. Orientations and
/// radii are the newest ones. Has no clock and no thread: times are its caller's.
class CausalTrack {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit CausalTrack(const TrackSettings& settings);

  /// Takes in a frame, whose velocities are not used. False, and nothing changes, unless
  /// `frame.time` is later than that of the last one. Allocates nothing.
  /// @pre finite joints; two hands differ in id or side.
  bool add(const HandFrame& frame) noexcept;

  /// The hands at `time` [s], not before that of the newest frame. A hand that no frame has had for
  /// longer than `max_gap` is gone. Sets `age` to `time` less the newest frame's time, to 0 before
  /// the first one. Allocates nothing.
  void sample(double time, HandFrame& out) const noexcept;

  /// Forgets all frames.
  void clear() noexcept;

 private:
  static constexpr std::size_t kFrames = 64;  // of the past: 0.5 s at 120 Hz

  /// One hand's frames, the newest at `newest`; older ones go backwards through the ring.
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
  double newest_time_ = 0.0;  // of all frames [s]
  bool any_ = false;
  std::array<Track, 2> tracks_;
};

}  // namespace prostm
