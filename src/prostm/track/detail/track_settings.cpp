#include "prostm/track/detail/track_settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

void require_factor(const char* name, double value) {
  if (value > 0.0 && value <= 1.0) return;
  std::ostringstream sentence;
  sentence << name << " = " << value << " must be above 0 and at most 1, where 1 is no filter";
  throw std::invalid_argument(sentence.str());
}

}  // namespace

void TrackSettings::visit(SettingsVisitor& v) {
  v.field("smoothing_time", smoothing_time);
  v.field("max_speed", max_speed);
  v.field("max_gap", max_gap);
  v.field("least_confidence", least_confidence);
  v.field("freeze_time", freeze_time);
  v.field("prediction", prediction);
  v.field("prediction_limit", prediction_limit);
  v.field("filter_position", filter_position);
  v.field("filter_velocity", filter_velocity);
  v.field("filter_position_scale", filter_position_scale);
  v.field("filter_velocity_scale", filter_velocity_scale);
}

void ScriptedHandSettings::visit(SettingsVisitor& v) {
  v.field("height", height);
  v.field("period", period);
  v.field("jitter", jitter);
  v.field("seed", seed);
  v.field("still", still);
}

void validate(const TrackSettings& settings) {
  require_between("smoothing_time", settings.smoothing_time, 0.001, 0.5, "s");
  require_between("max_speed", settings.max_speed, 0.01, 100.0, "m/s");
  require_between("max_gap", settings.max_gap, 0.001, 10.0, "s");
  require_between("least_confidence", settings.least_confidence, 0.0, 1.0, "");
  require_between("freeze_time", settings.freeze_time, 0.05, 60.0, "s");
  require_between("prediction", settings.prediction, 0.0, 0.2, "s");
  require_between("prediction_limit", settings.prediction_limit, 0.0, 0.1, "m");
  require_factor("filter_position", settings.filter_position);
  require_factor("filter_velocity", settings.filter_velocity);
  require_between("filter_position_scale", settings.filter_position_scale, 1e-5, 1.0, "m");
  require_between("filter_velocity_scale", settings.filter_velocity_scale, 1e-4, 100.0, "m/s");
}

void validate(const ScriptedHandSettings& settings) {
  require_between("height", settings.height, 0.10, 0.60, "m");
  require_between("period", settings.period, 5.0, 3600.0, "s");
  require_between("jitter", settings.jitter, 0.0, 0.01, "m");
  require_between("seed", settings.seed, 0, std::numeric_limits<int>::max());
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
               << " and the same side; a hand must be there once";
      throw std::invalid_argument(sentence.str());
    }
    last = frame.time;
  }
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
