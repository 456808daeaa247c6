#pragma once
/// Sources of hands.

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "prostm/core/settings.hpp"
#include "prostm/track/hand_faults.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// State of a live tracker at one moment, in plain values.
struct TrackerStatus {
  bool connected = false;
  std::int64_t frames = 0;   ///< frames received
  std::int64_t dropped = 0;  ///< received frames refused for their content
  /// frames and hands refused for their content, by cause; the frame of a refused hand is kept
  std::array<std::int64_t, kHandFaults> faults{};
  std::int64_t dropped_hands = 0;  ///< hands refused for their content
  std::int64_t repeated = 0;       ///< received frames with a time stamp seen before
  std::int64_t unsure = 0;         ///< hands ignored: below TrackSettings::least_confidence
  std::int64_t frozen = 0;         ///< hands ignored: no joint moved for TrackSettings::freeze_time
  std::int64_t reconnects = 0;     ///< connections after the first one
  std::string sentence;            ///< for the user: the connection, and what is wrong
};

/// Contents of a recording's file, and what was dropped.
struct HandReading {
  std::string file;
  std::int64_t frames = 0, hands = 0;  ///< in the file, the dropped ones included
  HandFaults faults;
  /// a doubt about the axes of the recording; empty without a doubt
  std::string doubt;
};

/// Hands as a function of time. Frames are in T. Not thread-safe: one caller, except for
/// tracker_status().
class HandSource {
 public:
  virtual ~HandSource() = default;
  /// Sets `out` to the hands at `time` [s], counted from 0 at the start of the run; times must not
  /// decrease from call to call. A frame without hands is a normal result. Allocates nothing.
  virtual void sample(double time, HandFrame& out) = 0;

  /// Length of the recording that is played, 0 without one [s].
  virtual double recording_length() const { return 0.0; }
  /// Time in the recording at the last sample(), NaN without one [s].
  virtual double recording_time() const { return std::numeric_limits<double>::quiet_NaN(); }
  /// Continues from `time` of the recording [s], clamped to its length, at the next sample(); hands
  /// get new ids. Does nothing without a recording.
  virtual void seek(double time) { static_cast<void>(time); }

  /// The contents of the recording that is played, null without a recording.
  virtual const HandReading* reading() const { return nullptr; }

  /// Empty for hands that are not tracked live. May be called from any thread.
  virtual std::optional<TrackerStatus> tracker_status() const { return {}; }
};

struct TrackSettings {
  /// width of the window in which joints are smoothed before they are differentiated [s]
  double smoothing_time = 0.030;
  /// joint velocities are clamped to this magnitude, since trackers glitch [m/s]
  double max_speed = 3.0;
  /// hands of live trackers, and of recordings in real time, are predicted over the age of their
  /// frame plus this time; 0: no prediction [s]
  double prediction = 0.015;
  double prediction_limit = 0.015;  ///< no joint is predicted farther than this [m]
  double max_gap = 0.060;  ///< a hand missing for longer than this between two frames is gone [s]
  double least_confidence = 0.1;  ///< hands of lower confidence are ignored, 0 to 1
  /// a live tracker's hand of which no joint has moved for this long is ignored until it moves
  /// again [s]
  double freeze_time = 0.5;
  /// α of the filter on still joints at the pipeline's rate, (0, 1]; 1 = no filter
  double filter_position = 0.3;
  /// low-pass of steady velocities at the pipeline's rate, (0, 1]; 1 = no filter
  double filter_velocity = 0.2;
  /// innovation of a position at which the filter is half open [m]
  double filter_position_scale = 0.003;
  /// innovation of a velocity at which the low-pass is half open [m/s]
  double filter_velocity_scale = 0.100;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const TrackSettings&) const = default;
};

/// A recording: frames at irregular times, as read by `io`.
struct HandRecording {
  std::vector<HandFrame> frames;  ///< times strictly increasing, the first at 0; velocities not set
  std::string description;
  HandReading reading;
};

/// Plays a recording. Between frames positions are interpolated linearly and orientations by slerp,
/// hand by hand (by id and side); velocities are central differences of joints smoothed over
/// `smoothing_time` (H1), clamped. If `loop`, the recording restarts after two steps [s] without a
/// hand, so that a caller with that step sees at least one frame without hands; no velocity is
/// computed across the restart. A hand whose tracker changed its id between two frames keeps its
/// first id.
/// @throws std::invalid_argument: a setting outside its bounds, no frames, times that do not
/// increase from 0, two hands of the same id and side in one frame, or several frames of which no
/// two within max_gap have a hand in common.
std::unique_ptr<HandSource> make_recorded_hand(HandRecording recording,
                                               const TrackSettings& settings, bool loop,
                                               double step);

/// Plays a recording as a tracker would have sent it: only frames up to the sampled time are used.
/// CausalTrack makes hands from them, with the age of the newest one. If `loop`, frames without
/// hands follow the end, and the recording restarts after its last hands are gone and a caller with
/// `step` [s] between samples has seen a frame without hands.
/// @throws std::invalid_argument as make_recorded_hand.
std::unique_ptr<HandSource> make_replayed_hand(HandRecording recording,
                                               const TrackSettings& settings, bool loop,
                                               double step);

/// The endless motion of a kinematic skeleton with bone lengths and joint angles: an open right
/// hand, palm down, comes in from the user's side, hovers over the middle of the tracker, lowers
/// and lifts, tilts, closes and opens, and leaves, in cycles of `period`.
struct ScriptedHandSettings {
  double height = 0.20;  ///< height of the hovering palm joint above the tracker [m], 0.10 to 0.60
  double period = 20.0;  ///< duration of a cycle [s], 5 to 3600
  double jitter = 0.0;   ///< standard deviation of white noise on each joint coordinate of each
                         ///< tracker frame [m], 0 to 0.01
  int seed = 1;          ///< seed of the jitter
  bool still = false;    ///< the hand keeps its hovering pose

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};
/// Without jitter velocities are exact (central differences of the motion itself); with jitter the
/// hand is seen as by a tracker of 110 Hz: joints are interpolated between noisy frames and
/// velocities come from them by (H1).
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_scripted_hand(const ScriptedHandSettings& settings,
                                               const TrackSettings& track);

/// A hand that is held as participants of a study hold theirs: flat, fingers together, palm towards
/// the array, still. Its pose is that of `--hand study`.
struct StudyHandSettings {
  double height = 0.215;  ///< height of the palm joint above the tracker [m], 0.05 to 0.60
  double size = 1.0;      ///< all lengths over those of an average hand, 0.7 to 1.3
  Side side = Side::Right;

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_study_hand(const StudyHandSettings& settings);

/// Removes the tracker's noise before hands enter the fluid: each joint is predicted with its
/// filtered velocity and corrected by a share of the innovation; its velocity and orientation are
/// low-passed. The shares grow with the innovation, so noise is damped and real motion passes: (H5)
/// to (H7) of docs/design/hands.md. Without the filter, a still hand tracked with 0.3 mm of noise
/// makes more pressure than the smoke.
class HandFilter {
 public:
  /// @throws std::invalid_argument for a setting outside its bounds.
  explicit HandFilter(const TrackSettings& settings);
  /// Filters `frame` in place, dt [s] after the previous one. A hand with a new id starts
  /// unfiltered.
  void apply(double dt, HandFrame& frame) noexcept;

 private:
  TrackSettings settings_;
  HandFrame state_;
};

}  // namespace prostm
