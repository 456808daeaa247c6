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
  /// Takes the oldest waiting frame; false if no frame waits. `frame.time` is its arrival on
  /// steady_now(), corrected for transport jitter if the tracker stamps its frames (never later
  /// than the arrival). One thread; neither waits nor allocates. If nobody takes frames for a
  /// while, newer ones are lost.
  virtual bool next(HandFrame& frame) = 0;
  /// If false, there is no hand, whatever came before. Any thread; neither waits nor allocates.
  virtual bool connected() const noexcept = 0;
  /// Any thread.
  virtual TrackerStatus status() const = 0;
};

/// Adds what a tracker dropped to its status, with a message.
void add_faults(const HandFaults& faults, TrackerStatus& status);

/// Makes hands from a tracker with CausalTrack, at the moment of each sample(); its argument is
/// only passed on. HandWatch removes false hands, and without a connection there are no hands.
/// Endless.
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_live_hand(std::unique_ptr<LiveTracker> tracker,
                                           const TrackSettings& settings);

/// Computes a frame's arrival without transport jitter from the tracker's stamp: stamp + the least
/// delay so far between the two clocks. That delay grows by 0.1 % of the time, since clocks drift.
class StampClock {
 public:
  /// @param stamp of the tracker [s], any origin.  @param arrival on steady_now() [s].
  /// @return at most `arrival`, and at most 0.1 s before it; nothing for a stamp that was seen
  /// already: the newest one, or up to 0.1 s before it. An older stamp means that the clock was set
  /// anew.
  std::optional<double> time_of(double stamp, double arrival) noexcept;
  /// Forgets the delay, for a new connection. Stamps that were seen stay seen.
  void reset() noexcept { started_ = false; }

 private:
  bool started_ = false;
  double newest_ = -std::numeric_limits<double>::infinity();  // stamp [s]
  double delay_ = 0.0, last_arrival_ = 0.0;                   // [s]
};

}  // namespace prostm
