#include "prostm/viewer/detail/state_json.hpp"

#include <fmt/format.h>

#include <array>

namespace prostm::viewer {
namespace {

// in the order of ControlKind
constexpr std::array<const char*, 3> kKinds = {"number", "choice", "switch"};

std::string text(std::string_view view) {
  return std::string(view);
}

Json choices_json(const RunControl& control, const LiveSettings& settings) {
  Json choices = Json::array();
  for (std::size_t i = 0; i < control.choices.size(); ++i) {
    if (control.available != nullptr && !control.available(settings, i)) continue;
    choices.push_back(
        {{"value", text(control.choices[i].value)}, {"label", text(control.choices[i].label)}});
  }
  return choices;
}

/// A control's value in the form used by pages.
Json value_json(const RunControl& control, double value) {
  if (control.kind == ControlKind::Switch) return value != 0.0;
  if (control.kind == ControlKind::Number) return value;
  return text(control.choices[static_cast<std::size_t>(value)].value);
}

Json control_json(const RunControl& control, const LiveSettings& settings,
                  const LiveSettings& start) {
  Json json = {
      {"id", text(control.id)}, {"group", text(control.group)}, {"label", text(control.label)}};
  json["kind"] = kKinds[static_cast<std::size_t>(control.kind)];
  json["value"] = value_json(control, control.get(settings));
  json["default"] = value_json(control, control.get(start));
  if (control.kind == ControlKind::Number) {
    json["min"] = control.low;
    json["max"] = control.high;
    json["step"] = control.step;
  } else if (control.kind == ControlKind::Choice) {
    json["choices"] = choices_json(control, settings);
  }
  json["help"] = text(control.help);
  if (!control.unit.empty()) json["unit"] = text(control.unit);
  json["enabled"] = control.enabled(settings);
  return json;
}

/// A button that sets a control, for pages.
Json offer_json(const Advice& advice) {
  switch (advice.kind) {
    case AdviceKind::OneField:
      return {{"id", "parts"}, {"value", false}, {"label", "Leave out both parts"}};
    case AdviceKind::Grid:
      return {{"id", "grid"},
              {"value", advice.cells},
              {"label", fmt::format("Turn the smoke's grid down to {} cells", advice.cells)}};
    case AdviceKind::FastPreset:
      return {{"id", "preset"}, {"value", "fast"}, {"label", "Use the preset Fast"}};
    default:
      return nullptr;
  }
}

Json advice_json(const Advice& advice, const PipelineSettings& settings) {
  if (advice.kind == AdviceKind::None) return nullptr;
  return {{"sentence", sentence(advice, settings)}, {"set", offer_json(advice)}};
}

}  // namespace

Json millimetres(const Vec3& p) {
  return {1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()};
}

Json controls_json(const LiveSettings& settings, const LiveSettings& start) {
  Json controls = Json::array();
  for (const RunControl& control : run_controls())
    controls.push_back(control_json(control, settings, start));
  return controls;
}

Json transport_json(const LiveState& state, PageHandState hand, std::uint32_t holder) {
  const bool in_charge = hand == PageHandState::Held;
  Json json = {{"playing", state.playing}, {"recording", nullptr}};
  if (state.recording_length > 0.0)
    json["recording"] = {{"length_s", state.recording_length}, {"seekable", true}};
  json["source"] = in_charge ? "page" : state.settings.source;
  json["base"] = state.settings.source;
  json["hand_page"] = in_charge && holder != 0 ? Json(holder) : Json(nullptr);
  json["page_hand"] = name_of(hand);
  return json;
}

Json rates_json(const PipelineSettings& settings, const Advice& advice) {
  return {{"world_hz", settings.world_rate},
          {"plan_hz", settings.world_rate / settings.steps_per_plan()},
          {"advice", advice_json(advice, settings)}};
}

Json tracker_json(const std::optional<TrackerStatus>& tracker) {
  if (!tracker) return nullptr;
  return {{"connected", tracker->connected}, {"sentence", tracker->sentence},
          {"frames", tracker->frames},       {"dropped", tracker->dropped},
          {"repeated", tracker->repeated},   {"dropped_hands", tracker->dropped_hands},
          {"unsure", tracker->unsure},       {"frozen", tracker->frozen}};
}

Json calibration_json(const std::optional<CalibrationGuide>& steps, bool saved,
                      const std::string& file, bool muted) {
  if (!steps) return nullptr;
  Json json = {{"marks", Json::array()}, {"residual_mm", nullptr}};
  for (const CalibrationMark& mark : steps->marks()) {
    Json one = {{"name", mark.name},
                {"p_mm", millimetres(mark.p_D)},
                {"taken", mark.taken},
                {"spread_mm", nullptr}};
    if (mark.taken) one["spread_mm"] = 1e3 * mark.spread;
    json["marks"].push_back(one);
  }
  if (steps->result()) json["residual_mm"] = 1e3 * steps->result()->rms;
  json["file"] = file;
  json["saved"] = saved;
  json["sentence"] = steps->sentence();
  json["muted"] = muted;
  return json;
}

}  // namespace prostm::viewer
