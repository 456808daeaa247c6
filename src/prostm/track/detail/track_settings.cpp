#include "prostm/track/detail/track_settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "prostm/core/settings.hpp"

namespace prostm {
namespace {

void require_factor(const char* name, double value) {
  if (value > 0.0 && value <= 1.0) return;
  std::ostringstream sentence;
  sentence << name << " = " << value << " must be above 0 and at most 1, where 1 means no filter";
  throw std::invalid_argument(sentence.str());
}

template <class Settings, class Visitor>
void list_track(Settings& s, Visitor& v) {
  v.field({"smoothing_time", "s", 0.001, 0.5,
           "window for smoothing joints before they are differentiated"},
          s.smoothing_time);
  v.field({"max_speed", "m/s", 0.01, 100,
           "joint velocities are clamped to this; faster ones are glitches"},
          s.max_speed);
  v.field({"max_gap", "s", 0.001, 10, "a hand missing for longer is gone"}, s.max_gap);
  v.field({"least_confidence", "", 0, 1, "hands of lower confidence are ignored"},
          s.least_confidence);
  v.field({"freeze_time", "s", 0.05, 60,
           "a live hand that has not moved any joint for this long is "
           "not taken"},
          s.freeze_time);
  v.field({"prediction", "s", 0, 0.2,
           "hands are predicted this far beyond the age of their frame; "
           "0: no prediction"},
          s.prediction);
  v.field({"prediction_limit", "m", 0, 0.1, "no joint is predicted farther than this"},
          s.prediction_limit);
  v.field({"filter_position", "", 0, 1,
           "filter coefficient of a still joint's position, above 0; "
           "1: no filter"},
          s.filter_position);
  v.field({"filter_velocity", "", 0, 1, "filter coefficient of a joint's velocity"},
          s.filter_velocity);
  v.field({"filter_position_scale", "m", 1e-5, 1, "innovation at which the filter is half open"},
          s.filter_position_scale);
  v.field(
      {"filter_velocity_scale", "m/s", 1e-4, 100, "filter_position_scale for a joint's velocity"},
      s.filter_velocity_scale);
}

template <class Settings, class Visitor>
void list_scripted(Settings& s, Visitor& v) {
  constexpr int kSeeds = std::numeric_limits<int>::max();
  v.field({"height", "m", 0.10, 0.60, "height of the hovering palm above the tracker"}, s.height);
  v.field({"period", "s", 5, 3600, "period of the hand's cycle"}, s.period);
  v.field({"jitter", "m", 0, 0.01, "standard deviation of a joint's noise"}, s.jitter);
  v.field({"seed", "", 0, kSeeds, "seed of the joints' noise"}, s.seed);
  v.field({.name = "still", .help = "whether the hand hovers and does not move"}, s.still);
}

template <class Settings, class Visitor>
void list_study(Settings& s, Visitor& v) {
  v.field({"height", "m", 0.05, 0.60, "height of the palm joint above the tracker"}, s.height);
  v.field({"size", "", 0.7, 1.3, "all lengths over those of an average hand"}, s.size);
  v.field({.name = "side", .help = "which hand it is"}, s.side);
}

}  // namespace

void TrackSettings::visit(SettingsReader& v) const {
  list_track(*this, v);
}
void TrackSettings::visit(SettingsWriter& v) {
  list_track(*this, v);
}
void ScriptedHandSettings::visit(SettingsReader& v) const {
  list_scripted(*this, v);
}
void ScriptedHandSettings::visit(SettingsWriter& v) {
  list_scripted(*this, v);
}

void StudyHandSettings::visit(SettingsReader& v) const {
  list_study(*this, v);
}
void StudyHandSettings::visit(SettingsWriter& v) {
  list_study(*this, v);
}

void validate(const TrackSettings& settings) {
  require_factor("filter_position", settings.filter_position);
  require_factor("filter_velocity", settings.filter_velocity);
  require_bounds(settings);
}

void validate(const StudyHandSettings& settings) {
  require_bounds(settings);
}
void validate(const ScriptedHandSettings& settings) {
  require_bounds(settings);
}

void validate_recording(const HandRecording& recording) {
  if (recording.frames.empty())
    throw std::invalid_argument("the recording has 0 frames; it must have at least 1");
  double last = 0.0;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const HandFrame& frame = recording.frames[i];
    std::ostringstream sentence;
    if (!std::isfinite(frame.time) || (i == 0 ? frame.time != 0.0 : frame.time <= last)) {
      sentence << "frame " << i << " of the recording is at " << frame.time
               << " s; times must increase from 0";
      throw std::invalid_argument(sentence.str());
    }
    if (frame.hands.size() == 2 && frame.hands[0].id == frame.hands[1].id &&
        frame.hands[0].side == frame.hands[1].side) {
      sentence << "frame " << i << " of the recording has two hands of id " << frame.hands[0].id
               << " and the same side; ids must differ";
      throw std::invalid_argument(sentence.str());
    }
    last = frame.time;
  }
}

TrackSettings with_gap_for(const HandRecording& recording, const TrackSettings& settings) {
  constexpr double kLongest = 0.09;  // usual interval [s]
  validate(settings);
  TrackSettings out = settings;
  std::vector<double> steps;
  for (std::size_t i = 1; i < recording.frames.size(); ++i)
    steps.push_back(recording.frames[i].time - recording.frames[i - 1].time);
  if (steps.empty()) return out;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  if (*middle <= kLongest) out.max_gap = std::max(out.max_gap, 2.0 * *middle);
  return out;
}

void leave_out_unsure(const TrackSettings& settings, HandRecording& recording) {
  std::size_t hands = 0, left = 0;
  double most = 0.0;
  for (HandFrame& frame : recording.frames) {
    hands += frame.hands.size();
    for (const Hand& hand : frame.hands) most = std::max(most, hand.confidence);
    const auto unsure = [&](const Hand& hand) {
      return hand.confidence < settings.least_confidence;
    };
    frame.hands.erase(std::remove_if(frame.hands.begin(), frame.hands.end(), unsure),
                      frame.hands.end());
    left += frame.hands.size();
  }
  if (hands == 0 || left > 0) return;
  std::ostringstream sentence;
  sentence << "all " << hands << " hands of the recording have a confidence of at most " << most
           << ", below least_confidence = " << settings.least_confidence
           << " of [track]; lower it to play them";
  throw std::invalid_argument(sentence.str());
}

void validate_step(double step) {
  if (step > 0.0 && step <= 10.0) return;
  std::ostringstream sentence;
  sentence << "step = " << step << " s must be above 0 s and at most 10 s";
  throw std::invalid_argument(sentence.str());
}

}  // namespace prostm
