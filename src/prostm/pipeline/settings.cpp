#include "prostm/pipeline/settings.hpp"

#include "prostm/acoustics/focus_width.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/drive.hpp"
#include "prostm/emit/played.hpp"

namespace prostm {

void PipelineSettings::visit(SettingsVisitor& v) {
  v.field("scene", scene);
  v.field("method", method);
  v.field("device", device);
  v.field("array", array);
  v.field("array_width", array_width);
  v.field("tracker", tracker);
  v.field("fluid_rate", fluid_rate);
  v.field("fluid_steps_per_plan", fluid_steps_per_plan);
  v.field("frame_wait", frame_wait);
  v.field("side_view", side_view);
  v.field("threads", threads);
}

int PipelineSettings::steps_per_plan() const {
  if (fluid_steps_per_plan > 0) return fluid_steps_per_plan;
  return method_from_name(method) == Method::Am ? 1 : 2;
}

double PipelineSettings::emission_rate() const {
  return device_kind(device).info(device_setup()).emission_rate();
}

double PipelineSettings::sigma() const {
  return method_from_name(method) == Method::Am ? am.sigma : plan.sigma;
}

PlanSettings playable_plan_settings(const PipelineSettings& settings, double emission_rate) {
  PlanSettings plan = settings.plan;
  plan.rise_time = 1.0 / (largest_slew(settings.emit.fade_time, emission_rate) * emission_rate);
  plan.silent_below = settings.emit.silent_below;
  if (plan.full_scale_pressure == 0.0) plan.full_scale_pressure = settings.emit.full_scale_pressure;
  return plan;
}

PlanSettings plan_settings(const PipelineSettings& settings, double emission_rate) {
  PlanSettings plan = playable_plan_settings(settings, emission_rate);
  FocusWidths& out = plan.widths;
  if (!settings.array_width) out = {};
  if (!settings.array_width || !out.empty()) return plan;
  out.height = {0.10, 0.15, 0.20, 0.25, 0.30, 0.40};
  out.offset = {0.0, 0.03, 0.06, 0.09};
  out.tilt = {0.0, kPi / 9.0, kPi / 4.5, kPi / 3.0};
  out.sigma.clear();
  const PackedArray packed(settings.transducers, Medium{});
  for (const FocusWidthEntry& entry :
       focus_width_table(packed, Medium{}, out.height, out.offset, out.tilt)) {
    out.sigma.push_back(entry.width.sigma());
  }
  return plan;
}

EmitSettings emit_settings(const PipelineSettings& settings, double largest) {
  EmitSettings emit = settings.emit;
  if (emit.full_scale_pressure == 0.0)
    emit.full_scale_pressure = own_full_scale(settings.plan.gain, largest);
  return emit;
}

std::vector<std::pair<std::string, std::function<void(SettingsVisitor&)>>> settings_groups(
    PipelineSettings& settings) {
  const auto group = [](auto& stage) { return [&stage](SettingsVisitor& v) { stage.visit(v); }; };
  const auto contact = [&settings](SettingsVisitor& v) {
    settings.fluid_pressure.visit(v);
    settings.contact.visit(v);
  };
  return {{"pipeline", group(settings)},
          {"track", group(settings.track)},
          {"scripted_hand", group(settings.scripted_hand)},
          {"fluid", group(settings.fluid)},
          {"contact", contact},
          {"plan", group(settings.plan)},
          {"am", group(settings.am)},
          {"emit", group(settings.emit)},
          {"simulated_array", group(settings.simulated_array)}};
}

}  // namespace prostm
