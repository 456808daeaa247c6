/// A recording that is played as a tracker would have sent it.

#include <algorithm>
#include <cmath>

#include "prostm/track/detail/causal_track.hpp"
#include "prostm/track/detail/hand_ids.hpp"
#include "prostm/track/detail/track_settings.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

class ReplayedHand final : public HandSource {
 public:
  ReplayedHand(HandRecording recording, const TrackSettings& settings, bool loop, double step)
      : recording_(std::move(recording)), track_(settings), loop_(loop) {
    validate_recording(recording_);
    leave_out_unsure(settings, recording_);
    validate_step(step);
    keep_ids(recording_, settings);
    length_ = recording_.frames.back().time;
    blank_.time = length_;
    if (length_ > 0.0) interval_ = length_ / static_cast<double>(recording_.frames.size() - 1);
    history_ = std::max(settings.smoothing_time, settings.max_gap);
    // an interval longer than one step between the end and the new start holds at least one of the
    // caller's times
    period_ = length_ + settings.max_gap + 2.0 * step;
  }

  void sample(double time, HandFrame& out) override {
    if (target_) {
      start(time - *target_, *target_);
      target_.reset();
    }
    if (loop_ && time - shift_ >= period_) {
      start(shift_ + period_ * std::floor((time - shift_) / period_), 0.0);
    }
    const double now = time - shift_;
    const std::vector<HandFrame>& frames = recording_.frames;
    for (; next_ < frames.size() && frames[next_].time <= now; ++next_) track_.add(frames[next_]);
    while (loop_ && now >= blank_.time + interval_) {
      blank_.time += interval_;
      track_.add(blank_);
    }
    recording_time_ = std::clamp(now, 0.0, length_);
    track_.sample(now, out);
    out.time = time;
    if (!loop_ && now > length_) out.hands.clear();
    for (Hand& hand : out.hands) hand.id += kIdsPerSeek * starts_;
  }

  double recording_length() const override { return length_; }
  const HandReading* reading() const override { return &recording_.reading; }
  double recording_time() const override { return recording_time_; }
  void seek(double time) override { target_ = std::clamp(time, 0.0, length_); }

 private:
  /// Continues at recording time `from`, run time `shift` + `from`; uses frames shortly before it.
  void start(double shift, double from) {
    shift_ = shift;
    track_.clear();
    const auto first =
        std::find_if(recording_.frames.begin(), recording_.frames.end(),
                     [&](const HandFrame& frame) { return frame.time >= from - history_; });
    next_ = static_cast<std::size_t>(first - recording_.frames.begin());
    blank_.time = length_;
    ++starts_;
  }

  HandRecording recording_;
  CausalTrack track_;
  bool loop_;
  double length_ = 0.0, period_ = 0.0, history_ = 0.0;  // [s]
  double shift_ = 0.0;                                  // run time less recording time [s]
  double recording_time_ = 0.0;                         // at the last sample [s]
  std::optional<double> target_;                        // to be sampled next [s]
  std::size_t next_ = 0;                                // next frame to add
  HandFrame blank_;           // the latest frame after the recording's end, without hands
  double interval_ = 9.1e-3;  // mean interval of frames [s]
  std::int64_t starts_ = 0;
};

}  // namespace

std::unique_ptr<HandSource> make_replayed_hand(HandRecording recording,
                                               const TrackSettings& settings, bool loop,
                                               double step) {
  const TrackSettings fitted = with_gap_for(recording, settings);
  return std::make_unique<ReplayedHand>(std::move(recording), fitted, loop, step);
}

}  // namespace prostm
