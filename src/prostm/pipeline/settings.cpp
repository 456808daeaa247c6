#include "prostm/pipeline/settings.hpp"

#include <algorithm>

#include "prostm/acoustics/field/focus_width.hpp"
#include "prostm/core/units.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/emit/drive.hpp"
#include "prostm/emit/played.hpp"

namespace prostm {
namespace {

template <class Settings, class Visitor>
void list_all_but_world(Settings& s, Visitor& v) {
  v.field({.name = "scene", .help = "scene of the world"}, s.scene);
  v.field({.name = "method", .help = "rendering method"}, s.method);
  v.field({.name = "device", .help = "output device"}, s.device);
  v.field({.name = "array", .help = "the transducers, by name or a file"}, s.array);
  v.field({.name = "array_width",
           .help = "whether best, fast and felt use the width of the array's focus "
                   "instead of sigma"},
          s.array_width);
  v.field({.name = "tracker",
           .help = "pose of the tracker: centre, a kit such as ultraleap-kit, or a file"},
          s.tracker);
  v.field({"world_rate", "Hz", 10, 1000, "steps of the world"}, s.world_rate);
  v.field({"world_steps_per_plan", "", 0, 100,
           "steps of the world for each plan; 0: default of the method"},
          s.world_steps_per_plan);
  v.field({"frame_wait", "s", 0, 0.1, "longest wait of a step for a late tracker frame"},
          s.frame_wait);
  v.field({.name = "side_view", .help = "whether plan updates record a side view"}, s.side_view);
  v.field({"threads", "", 1, 256, "threads of the world"}, s.threads);
}

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({.name = "world", .help = "what presses on the hands"}, s.world);
  list_all_but_world(s, v);
}

}  // namespace

void PipelineSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void PipelineSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

int PipelineSettings::steps_per_plan() const {
  if (world_steps_per_plan > 0) return world_steps_per_plan;
  return method == Method::Am ? 1 : 2;
}

DeviceInfo PipelineSettings::device_info() const {
  return device_named(device).kind->info(device_setup());
}

double PipelineSettings::sigma() const {
  return method == Method::Am ? am.sigma : plan.sigma;
}

void set_live_budget(PipelineSettings& settings) {
  if (settings.method == Method::ProStm && settings.plan.budget == 0.0)
    settings.plan.budget = settings.plan.traits().live_budget;
}

PlanSettings playable_plan_settings(const PipelineSettings& settings, double emission_rate) {
  PlanSettings plan = settings.plan;
  plan.rise_time = 1.0 / (largest_slew(settings.emit.fade_time, emission_rate) * emission_rate);
  plan.silent_below = settings.emit.silent_below;
  if (plan.full_scale_pressure == 0.0) plan.full_scale_pressure = settings.emit.full_scale_pressure;
  return plan;
}

AmSettings am_settings(const PipelineSettings& settings, double emission_rate) {
  AmSettings am = settings.am;
  am.frequency = settings.emit.am_frequency;
  if (am.felt_weight > 0.0) am.widths = plan_settings(settings, emission_rate).widths;
  return am;
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

std::shared_ptr<const SafetyLevels> levels_of(const PipelineSettings& settings) {
  return std::make_shared<const SafetyLevels>(settings.transducers, Medium{},
                                              settings.safety.head_distance);
}

double power_limit(const PipelineSettings& settings) {
  return std::min(settings.emit.power_limit, settings.safety.power);
}

EmitSettings emit_settings(const PipelineSettings& settings, double largest) {
  EmitSettings emit = settings.emit;
  if (emit.full_scale_pressure == 0.0)
    emit.full_scale_pressure = own_full_scale(settings.plan.gain, largest);
  emit.power_limit = power_limit(settings);
  return emit;
}

namespace {

template <class Settings>
std::vector<SettingsGroup> groups_of(Settings& s) {
  std::vector<SettingsGroup> groups = {group_of("pipeline", s),
                                       group_of("track", s.track),
                                       group_of("scripted_hand", s.scripted_hand),
                                       group_of("study_hand", s.study_hand),
                                       group_of("fluid", s.fluid),
                                       group_of("box", s.box),
                                       group_of("jets", s.jets),
                                       group_of("contact", s.fluid_pressure, s.contact),
                                       group_of("plan", s.plan),
                                       group_of("am", s.am),
                                       group_of("emit", s.emit),
                                       group_of("safety", s.safety)};
  for (const DeviceKind& kind : device_kinds()) {
    if (kind.settings != nullptr) groups.push_back(group_of(*kind.settings, s.devices));
  }
  return groups;
}

}  // namespace

std::vector<SettingsGroup> settings_groups(PipelineSettings& settings) {
  return groups_of(settings);
}
std::vector<SettingsGroup> settings_groups(const PipelineSettings& settings) {
  return groups_of(settings);
}
std::vector<SettingsGroup> study_settings_groups(const PipelineSettings& settings) {
  std::vector<SettingsGroup> groups = groups_of(settings);
  if (settings.world != PipelineSettings().world) return groups;
  groups.front().read = [&settings](SettingsReader& v) { list_all_but_world(settings, v); };
  return groups;
}

}  // namespace prostm
