#pragma once
/// Where hands come from.

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/settings.hpp"
#include "track/hand_frame.hpp"

namespace prostm {

/// Hands as a function of time. Frames are in T. Not thread-safe: one caller.
class HandSource {
 public:
  virtual ~HandSource() = default;
  /// The hands at `time` [s], counted from 0 at the start of the run; times must not decrease from call to call. No hand
  /// in sight is an ordinary answer. Allocates nothing.
  virtual void sample(double time, HandFrame& out) = 0;
  /// Seconds after which sample() has nothing new; infinity for a source without an end.
  virtual double duration() const = 0;
};

struct TrackSettings {
  double smoothing_time = 0.030;    ///< width of the window in which joints are smoothed before they are differentiated [s]
  double max_speed = 3.0;           ///< joint velocities are clamped to this magnitude: trackers glitch [m/s]
  double max_gap = 0.060;           ///< a hand missing for longer than this between two frames is gone [s]
  double filter_position = 0.3;     ///< α of the α-β filter on the joints at the pipeline's rate; 1 = no filter
  double filter_velocity = 0.2;     ///< low-pass of the joints' velocities at the pipeline's rate; 1 = no filter

  void visit(SettingsVisitor& v);
};

/// A recording: frames at irregular times, as read by `io`.
struct HandRecording {
  std::vector<HandFrame> frames;    ///< times strictly increasing, the first at 0; velocities not set
  std::string description;
};

/// Plays a recording. Between frames positions are interpolated linearly and orientations by slerp, hand by hand (by
/// id); velocities are central differences of joints smoothed over `smoothing_time`, clamped. When `loop`, the recording
/// starts again as a hand that leaves and comes back: at least one step without a hand, no velocity across the seam.
std::unique_ptr<HandSource> make_recorded_hand(HandRecording recording, const TrackSettings& settings, bool loop,
                                               double step);

/// A kinematic skeleton with bone lengths and joint angles, endless: an open right hand comes in, hovers, lowers and
/// lifts, tilts, closes and opens, leaves, and so on in a cycle of `period` [s].
struct ScriptedHandSettings {
  double height = 0.20;        ///< of the hovering palm above the tracker [m]
  double period = 20.0;        ///< [s]
  double jitter = 0.0;         ///< standard deviation of white noise on each joint coordinate, as a tracker has [m]
  int seed = 1;                ///< of the jitter
  bool still = false;          ///< the hovering pose for ever

  void visit(SettingsVisitor& v);
};
std::unique_ptr<HandSource> make_scripted_hand(const ScriptedHandSettings& settings, const TrackSettings& track);

/// Takes the tracker's noise out before the fluid sees it: an α-β filter on each joint and a low-pass on its velocity.
/// Without it a hand that is still but tracked with 0.3 mm of noise makes more pressure than the smoke (docs/design.md).
class HandFilter {
 public:
  /// @throws std::invalid_argument for a factor outside (0, 1].
  explicit HandFilter(const TrackSettings& settings);
  /// Filters `frame` in place, dt [s] after the previous one. A hand with a new id starts unfiltered.
  void apply(double dt, HandFrame& frame) noexcept;

 private:
  TrackSettings settings_;
  HandFrame state_;
};

}  // namespace prostm
