#include "prostm/track/live/live_tracker.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prostm/core/stage_timer.hpp"
#include "prostm/track/detail/causal_track.hpp"
#include "prostm/track/detail/hand_watch.hpp"

namespace prostm {
namespace {

constexpr double kDrift = 1e-3;        // largest drift between two clocks
constexpr double kLongestDelay = 0.1;  // a longer delay means that a clock was reset [s]

class LiveHand final : public HandSource {
 public:
  LiveHand(std::unique_ptr<LiveTracker> tracker, const TrackSettings& settings)
      : tracker_(std::move(tracker)), watch_(settings), track_(settings) {}

  void sample(double time, HandFrame& out) override {
    while (tracker_->next(frame_)) {
      watch_.check(frame_);
      track_.add(frame_);
    }
    if (!tracker_->connected()) track_.clear();
    track_.sample(steady_now(), out);
    out.time = time;
  }
  std::optional<TrackerStatus> tracker_status() const override {
    TrackerStatus status = tracker_->status();
    watch_.report(status);
    return status;
  }

 private:
  std::unique_ptr<LiveTracker> tracker_;
  HandWatch watch_;
  CausalTrack track_;
  HandFrame frame_;
};

}  // namespace

std::unique_ptr<HandSource> make_live_hand(std::unique_ptr<LiveTracker> tracker,
                                           const TrackSettings& settings) {
  return std::make_unique<LiveHand>(std::move(tracker), settings);
}

void add_faults(const HandFaults& faults, TrackerStatus& status) {
  status.dropped = faults.frames();
  status.dropped_hands = faults.hands();
  status.faults = faults.count;
  if (!faults.any()) return;
  status.sentence +=
      fmt::format("; {} frames and {} hands were dropped ({}), the last since {}", status.dropped,
                  status.dropped_hands, causes_of(faults), faults.last);
}

std::optional<double> StampClock::time_of(double stamp, double arrival) noexcept {
  if (stamp <= newest_ && stamp > newest_ - kLongestDelay) return {};
  newest_ = stamp;
  const double delay = arrival - stamp;
  if (started_) delay_ += kDrift * std::max(arrival - last_arrival_, 0.0);
  if (!started_ || delay < delay_ || delay > delay_ + kLongestDelay) delay_ = delay;
  started_ = true;
  last_arrival_ = arrival;
  return std::min(stamp + delay_, arrival);
}

}  // namespace prostm
