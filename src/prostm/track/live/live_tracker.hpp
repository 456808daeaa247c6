#pragma once
/// Trackers that receive frames on their own thread, and the hands made from them.

#include <limits>
#include <memory>
#include <optional>

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Frames in order of arrival. Implementations receive them on a thread of their own.
class LiveTracker {
 public:
  virtual ~LiveTracker() = default;
  /// Takes the oldest queued frame; false if the queue is empty. `frame.time` is its arrival on
  /// steady_now(), corrected for transport jitter if the tracker stamps its frames (never later
  /// than the arrival). One thread; neither waits nor allocates. While the queue is full, new
  /// frames are dropped.
  virtual bool next(HandFrame& frame) = 0;
  /// If false, there are no hands, whatever was received before. Any thread; neither waits nor
  /// allocates.
  virtual bool connected() const noexcept = 0;
  /// Any thread.
  virtual TrackerStatus status() const = 0;
};

/// Adds the frames and hands that a tracker dropped to its status, with a message.
void add_faults(const HandFaults& faults, TrackerStatus& status);

/// Makes hands from a tracker with CausalTrack. Each sample() gives the hands at the moment of the
/// call; its time argument only becomes the frame's time. HandWatch removes false hands, and
/// without a connection there are no hands.
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_live_hand(std::unique_ptr<LiveTracker> tracker,
                                           const TrackSettings& settings);

/// Computes a frame's arrival without transport jitter from the tracker's time stamp: stamp + the
/// least delay so far between the two clocks. That delay grows by 0.1 % of the elapsed time, since
/// clocks drift.
class StampClock {
 public:
  /// @param stamp of the tracker [s], any origin.  @param arrival on steady_now() [s].
  /// @return at most `arrival`, and at most 0.1 s before it; nothing for a repeated stamp: the
  /// newest one, or one up to 0.1 s before it. An older stamp means that the tracker's clock was
  /// reset.
  std::optional<double> time_of(double stamp, double arrival) noexcept;
  /// Forgets the delay, for a new connection; repeated stamps are still recognised.
  void reset() noexcept { started_ = false; }

 private:
  bool started_ = false;
  double newest_ = -std::numeric_limits<double>::infinity();  // stamp [s]
  double delay_ = 0.0, last_arrival_ = 0.0;                   // [s]
};

}  // namespace prostm
