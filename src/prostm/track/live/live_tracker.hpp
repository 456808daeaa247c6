#pragma once
/// Trackers that send frames on a thread of their own, and the hands that come of them.

#include <limits>
#include <memory>
#include <optional>

#include "prostm/track/hand_source.hpp"

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
  /// False: no hand is there, whatever came before. Any thread; neither waits nor allocates.
  virtual bool connected() const noexcept = 0;
  /// Any thread.
  virtual TrackerStatus status() const = 0;
};

/// Hands of a tracker by CausalTrack, at the moment of each sample(): its argument is only passed
/// on. Hands that HandWatch leaves out are not taken, and none is there without a connection.
/// Endless.
/// @throws std::invalid_argument for a setting outside its bounds.
std::unique_ptr<HandSource> make_live_hand(std::unique_ptr<LiveTracker> tracker,
                                           const TrackSettings& settings);

/// When a frame came in but for the jitter of its way, from the tracker's own stamps: stamp + the
/// least delay so far between the two clocks, which is let grow by 0.1 % as clocks drift apart.
class StampClock {
 public:
  /// @param stamp of the tracker [s], any origin.  @param arrival on steady_now() [s].
  /// @return at most `arrival`, and at most 0.1 s before it; nothing for a stamp that was seen
  /// already: the newest one, or up to 0.1 s before it. One from long before is of a clock that was
  /// set anew.
  std::optional<double> time_of(double stamp, double arrival) noexcept;
  /// Frames come another way from now on. Stamps that were seen stay seen.
  void reset() noexcept { started_ = false; }

 private:
  bool started_ = false;
  double newest_ = -std::numeric_limits<double>::infinity();  // stamp [s]
  double delay_ = 0.0, last_arrival_ = 0.0;                   // [s]
};

}  // namespace prostm
