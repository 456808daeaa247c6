#pragma once
/// Trackers that send frames on a thread of their own, and the hands that come of them.

#include <memory>

#include "track/hand_source.hpp"

namespace prostm {

/// Frames as they come in. Whoever implements this receives them on a thread of its own.
class LiveTracker {
 public:
  virtual ~LiveTracker() = default;
  /// The oldest frame that was not taken yet; false when there is none. `frame.time` is when it
  /// came in, on steady_now(); where the tracker stamps its frames, freed of the jitter of their
  /// way here (never later). One thread; neither waits nor allocates. When nobody takes frames for
  /// a while newer ones are lost.
  virtual bool next(HandFrame& frame) = 0;
  /// Any thread.
  virtual TrackerStatus status() const = 0;
};

/// Hands of a tracker by CausalTrack, at the moment of each sample(): its argument is only passed
/// on. Endless.
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_live_hand(std::unique_ptr<LiveTracker> tracker,
                                           const TrackSettings& settings);

/// When a frame came in but for the jitter of its way, from the tracker's own stamps: stamp + the
/// least delay so far between the two clocks, which is let grow by 0.1 % as clocks drift apart.
class StampClock {
 public:
  /// @param stamp of the tracker [s], any origin.  @param arrival on steady_now() [s].
  /// @return at most `arrival`, and at most 0.1 s before it.
  double time_of(double stamp, double arrival) noexcept;
  void reset() noexcept { started_ = false; }

 private:
  bool started_ = false;
  double delay_ = 0.0, last_arrival_ = 0.0;  // [s]
};

}  // namespace prostm
