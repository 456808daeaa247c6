#include "prostm/study/session/marker.hpp"

#include <cmath>

namespace prostm {
namespace {

constexpr std::uint32_t kMask = (1U << 24U) - 1;

double microseconds(double seconds) {
  return std::round(1e6 * seconds) / 1e6;
}

}  // namespace

std::uint64_t Presentation::label() const {
  return std::uint64_t{number & kMask} << 40U | std::uint64_t{trial & kMask} << 16U | condition;
}

Presentation Presentation::of_label(std::uint64_t label) {
  return {static_cast<std::uint32_t>(label >> 40U),
          static_cast<std::uint32_t>(label >> 16U) & kMask, static_cast<std::uint16_t>(label)};
}

Presentation presentation_of(const StudySession& session, std::uint32_t number) {
  Presentation now;
  now.number = number;
  if (session.phase() != StudyPhase::Presenting) return now;
  if (session.practice_trial() > 0) return now;  // as in training
  now.trial = static_cast<std::uint32_t>(session.trials_done() + 1);
  const Protocol& protocol = session.protocol();
  if (!protocol.markers.conditions) return now;
  const Trial& trial = session.trial();
  const auto scenes = static_cast<int>(protocol.scenes.size());
  now.condition = static_cast<std::uint16_t>(trial.method * scenes + trial.scene + 1);
  return now;
}

std::uint8_t code_of(const Marker& marker) {
  const Presentation& p = marker.presentation;
  const auto code = [](MarkerCode c) { return static_cast<std::uint8_t>(c); };
  if (p.trial == 0) return code(marker.on ? MarkerCode::TrainingOn : MarkerCode::TrainingOff);
  if (!marker.on) return code(MarkerCode::Off);
  if (marker.part > 1) return code(MarkerCode::OnAgain);
  if (p.condition == 0) return code(MarkerCode::On);
  return static_cast<std::uint8_t>(code(MarkerCode::FirstCondition) + p.condition - 1);
}

nlohmann::ordered_json marker_json(const Marker& marker, const Protocol& protocol, int run) {
  const Presentation& p = marker.presentation;
  const std::string what = p.trial == 0 ? "training" : "stimulus";
  nlohmann::ordered_json json = {{"run", run},
                                 {"sequence", marker.sequence},
                                 {"event", what + (marker.on ? "-on" : "-off")},
                                 {"code", code_of(marker)},
                                 {"trial", p.trial},
                                 {"presentation", p.number},
                                 {"part", marker.part}};
  if (p.condition > 0) {
    const auto place = static_cast<std::size_t>(p.condition) - 1, scenes = protocol.scenes.size();
    json["method"] = protocol.methods[place / scenes].name;
    json["scene"] = protocol.scenes[place % scenes].name;
    json["played"] = marker.emission ? played_json(*marker.emission) : nullptr;
  }
  json["stream"] = marker.stream;
  json["sample"] = marker.sample;
  json["rate_hz"] = marker.sample_rate;
  const auto since = [&](double offset) -> nlohmann::ordered_json {
    if (!marker.played) return nullptr;
    return microseconds(*marker.played + offset);
  };
  json["played_s"] = since(0.0);
  json["played_utc_s"] = since(marker.utc_offset);
  json["sent_s"] = microseconds(marker.sent);
  json["late_ms"] = nullptr;
  if (marker.played) json["late_ms"] = microseconds(1e3 * (marker.sent - *marker.played));
  return json;
}

}  // namespace prostm
