/// A recording as a hand source.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "prostm/track/detail/hand_ids.hpp"
#include "prostm/track/detail/hand_track.hpp"
#include "prostm/track/detail/track_settings.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {
namespace {

/// A hand from its first frame to the last one before it is missing for longer than max_gap.
struct RecordedTrack {
  HandTrack track;
  std::vector<std::size_t> frames;  // in the recording, one per time of the track
};

/// Joins the hands of consecutive frames by id and side.
std::vector<RecordedTrack> join_tracks(const HandRecording& recording, double max_gap) {
  std::vector<RecordedTrack> tracks;
  std::vector<std::size_t> open;
  for (std::size_t f = 0; f < recording.frames.size(); ++f) {
    const HandFrame& frame = recording.frames[f];
    std::erase_if(
        open, [&](std::size_t n) { return frame.time - tracks[n].track.times.back() > max_gap; });
    for (const Hand& hand : frame.hands) {
      auto match = std::find_if(open.begin(), open.end(), [&](std::size_t n) {
        const Hand& known = tracks[n].track.hands.back();
        return known.id == hand.id && known.side == hand.side;
      });
      if (match == open.end()) {
        tracks.emplace_back();
        match = open.insert(open.end(), tracks.size() - 1);
      }
      RecordedTrack& joined = tracks[*match];
      joined.track.times.push_back(frame.time);
      joined.track.hands.push_back(hand);
      joined.frames.push_back(f);
    }
  }
  return tracks;
}

class RecordedHand final : public HandSource {
 public:
  RecordedHand(HandRecording recording, const TrackSettings& settings, bool loop, double step)
      : settings_(settings), loop_(loop) {
    validate(settings);
    validate_recording(recording);
    leave_out_unsure(settings, recording);
    validate_step(step);
    keep_ids(recording, settings);
    reading_ = std::move(recording.reading);
    for (const HandFrame& frame : recording.frames) times_.push_back(frame.time);
    // an interval longer than one step between the end and the new start holds at least one of the
    // caller's times
    period_ = times_.back() + 2.0 * step;
    tracks_ = join_tracks(recording, settings.max_gap);
    list_active();
  }

  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.age = 0.0;
    out.hands.clear();
    if (target_) {
      shift_ = *target_ - time;
      target_.reset();
      ++seeks_;
    }
    const double since = time + shift_;
    const double t = loop_ && since >= 0.0 ? std::fmod(since, period_) : since;
    recording_time_ = std::clamp(t, 0.0, times_.back());
    if (!(t >= 0.0 && t <= times_.back())) return;
    const auto frame = static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), t) -
                                                times_.begin()) -
                       1;
    for (const Active& active : active_[frame]) {
      const HandTrack& track = tracks_[active.track].track;
      if (t > track.times.back()) continue;
      out.hands.emplace_back();
      sample_track(track, active.index, t, settings_, out.hands.back());
      out.hands.back().id += kIdsPerSeek * seeks_;
    }
  }

  double recording_length() const override { return times_.back(); }
  const HandReading* reading() const override { return &reading_; }
  double recording_time() const override { return recording_time_; }
  void seek(double time) override { target_ = std::clamp(time, 0.0, times_.back()); }

 private:
  /// A track and its last frame at or before some frame of the recording.
  struct Active {
    std::size_t track, index;
  };

  /// Lists the tracks present from each frame to the next: first the hands of the frame, then, if
  /// there is room, hands that are missing for a moment.
  void list_active() {
    active_.resize(times_.size());
    for (std::size_t n = 0; n < tracks_.size(); ++n) {
      for (std::size_t i = 0; i < tracks_[n].frames.size(); ++i) {
        active_[tracks_[n].frames[i]].push_back({n, i});
      }
    }
    for (std::size_t n = 0; n < tracks_.size(); ++n) {
      const std::vector<std::size_t>& frames = tracks_[n].frames;
      for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
        for (std::size_t f = frames[i] + 1; f < frames[i + 1]; ++f) {
          if (active_[f].size() < active_[f].capacity()) active_[f].push_back({n, i});
        }
      }
    }
  }

  TrackSettings settings_;
  HandReading reading_;
  bool loop_;
  double period_ = 0.0;           // duration of the loop [s]
  double shift_ = 0.0;            // recording time less run time [s]
  double recording_time_ = 0;     // at the last sample [s]
  std::optional<double> target_;  // to be sampled next [s]
  std::int64_t seeks_ = 0;
  std::vector<double> times_;  // times of the recording's frames [s]
  std::vector<RecordedTrack> tracks_;
  std::vector<boost::container::static_vector<Active, 2>> active_;
};

}  // namespace

std::unique_ptr<HandSource> make_recorded_hand(HandRecording recording,
                                               const TrackSettings& settings, bool loop,
                                               double step) {
  const TrackSettings fitted = with_gap_for(recording, settings);
  return std::make_unique<RecordedHand>(std::move(recording), fitted, loop, step);
}

}  // namespace prostm
