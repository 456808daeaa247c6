#include "prostm/pipeline/controls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/names.hpp"
#include "prostm/core/units.hpp"
#include "prostm/pipeline/smoke/smoke_world.hpp"
#include "prostm/pipeline/world_kinds.hpp"

namespace prostm {
namespace {

// ---- lists of choices ----

/// Returns the names of an enum, with a label for each.
template <class E, std::size_t N>
std::array<ControlChoice, N> choices_of(const std::array<std::string_view, N>& labels) {
  std::array<ControlChoice, N> choices;
  for (std::size_t i = 0; i < N; ++i) choices[i] = {kNames<E>[i], labels[i]};
  return choices;
}

/// Scenes of all worlds.
std::vector<ControlChoice> all_scenes() {
  std::vector<ControlChoice> choices;
  for (const WorldKind& kind : world_kinds())
    for (const WorldScene& scene : kind.scenes()) choices.push_back({scene.name, scene.label});
  return choices;
}

std::vector<ControlChoice> preset_choices() {
  std::vector<ControlChoice> choices;
  for (const PresetTraits& traits : kPresetTraits) choices.push_back({traits.name, traits.title});
  return choices;
}

const std::vector<ControlChoice> kScenes = all_scenes();
const auto kJetPlaces = choices_of<JetPlace, 2>({"Over the array", "Under the hand"});
const auto kParts = choices_of<PressurePart, 3>({"All", "Smoke alone", "Movement alone"});
const auto kMethods = choices_of<Method, 2>({"PRO-STM", "AM"});
const std::vector<ControlChoice> kPresets = preset_choices();
const auto kSwitches = choices_of<SwitchAt, 2>({"At loop ends", "At once"});
const auto kWaveforms = choices_of<Waveform, 2>({"Raised cosine", "|sin|"});
constexpr ControlChoice kSources[] = {
    {"scripted", "Scripted"}, {"study", "Study hand"}, {"recording", "Recording"},
    {"leap", "Leap tracker"}, {"openxr", "OpenXR"},    {"page", "None: only the page's"}};

/// Index of a value in a list of choices; 0 if it is not in the list.
double place(std::span<const ControlChoice> choices, std::string_view value) {
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].value == value) return static_cast<double>(i);
  return 0.0;
}

std::string chosen(std::span<const ControlChoice> choices, double value) {
  return std::string(choices[static_cast<std::size_t>(value)].value);
}

// ---- when a control has an effect ----

bool always(const LiveSettings&) {
  return true;
}
bool is_am(const LiveSettings& s) {
  return s.pipeline.method == Method::Am;
}
bool is_pro_stm(const LiveSettings& s) {
  return !is_am(s);
}
bool is_fitted(const LiveSettings& s) {
  return is_pro_stm(s) && s.pipeline.plan.traits().is_fitted();
}
bool is_felt(const LiveSettings& s) {
  return is_pro_stm(s) && s.pipeline.plan.traits().chooses_by_percept;
}
bool has_smoke(const LiveSettings& s) {
  return is_smoke(s.pipeline);
}
bool has_jets(const LiveSettings& s) {
  return has_smoke(s) && s.pipeline.scene != "still-air";
}
/// Whether the scene at this index of kScenes belongs to the current world.
bool has_scene(const LiveSettings& s, std::size_t place) {
  for (const WorldKind& kind : world_kinds()) {
    const std::size_t scenes = kind.scenes().size();
    if (place < scenes) return s.pipeline.world == kind.name;
    place -= scenes;
  }
  return false;
}
bool has_source(const LiveSettings& s, std::size_t place) {
  return std::find(s.sources.begin(), s.sources.end(), kSources[place].value) != s.sources.end();
}

// ---- setters shared by controls ----

/// Sets the preset, and its time budget for real time.
void set_preset(LiveSettings& s, double value) {
  PlanSettings& plan = s.pipeline.plan;
  plan.preset = static_cast<Preset>(value);
  plan.budget = plan.traits().live_budget;
}

void set_paths(LiveSettings& s, double value) {
  s.pipeline.plan.paths = s.pipeline.am.foci = s.pipeline.emit.foci = static_cast<int>(value);
}

/// Sets one width for all places, instead of the array's own.
void set_sigma(LiveSettings& s, double millimetres) {
  s.pipeline.plan.sigma = s.pipeline.am.sigma = 1e-3 * millimetres;
  s.pipeline.array_width = false;
}

/// How a control reads and changes the settings.
struct Access {
  double (*get)(const LiveSettings&);
  void (*set)(LiveSettings&, double);
};

/// Access to one member of the settings. @param Of returns a reference to it; it captures nothing.
template <class Of>
Access member(Of) {
  return {[](const LiveSettings& s) { return static_cast<double>(Of{}(s)); },
          [](LiveSettings& s, double v) {
            auto& of = Of{}(s);
            of = static_cast<std::remove_reference_t<decltype(of)>>(v);
          }};
}

/// Collects the controls of a group.
class ControlList {
 public:
  using Settings = const LiveSettings&;
  using Enabled = bool (*)(Settings);

  explicit ControlList(std::string_view group) : group_(group) {}

  void number(std::string_view id, std::string_view label, std::string_view unit, double low,
              double high, double step, Access access, Enabled enabled, std::string_view help) {
    all_.push_back({.id = id,
                    .group = group_,
                    .label = label,
                    .help = help,
                    .unit = unit,
                    .low = low,
                    .high = high,
                    .step = step,
                    .choices = {},
                    .get = access.get,
                    .set = access.set,
                    .enabled = enabled});
  }
  void choice(std::string_view id, std::string_view label, std::span<const ControlChoice> choices,
              Access access, Enabled enabled, std::string_view help,
              bool (*available)(Settings, std::size_t place) = nullptr) {
    number(id, label, "", 0.0, static_cast<double>(choices.size()) - 1.0, 1.0, access, enabled,
           help);
    all_.back().kind = ControlKind::Choice;
    all_.back().choices = choices;
    all_.back().available = available;
  }
  void toggle(std::string_view id, std::string_view label, Access access, Enabled enabled,
              std::string_view help) {
    number(id, label, "", 0.0, 1.0, 1.0, access, enabled, help);
    all_.back().kind = ControlKind::Switch;
  }
  std::vector<RunControl> take() { return std::move(all_); }

 private:
  std::string_view group_;
  std::vector<RunControl> all_;
};

std::vector<RunControl> smoke_controls() {
  using S = LiveSettings;
  ControlList list("Smoke");
  list.choice(
      "scene", "Scene", kScenes,
      {[](const S& s) { return place(kScenes, s.pipeline.scene); },
       [](S& s, double v) { s.pipeline.scene = chosen(kScenes, v); }},
      always,
      "Smoke scene. Each scene has its own full scale: the pressure that gives full output.",
      has_scene);
  list.number(
      "jet_speed", "Emitter", "×", 0, 2, 0.05,
      member([](auto& s) -> auto& { return s.pipeline.fluid.jet_speed; }), has_jets,
      "Speed of the smoke that the emitter blows, over the scene's own. Pressure varies with its "
      "square.");
  list.choice(
      "jet_place", "Jets", kJetPlaces,
      member([](auto& s) -> auto& { return s.pipeline.jets.place; }), has_jets,
      "Over the array's middle, or where the palm is when you choose this, turned and sized with "
      "it.");
  list.number("trim_rate", "Trim", "1/s", 0, 1, 0.05,
              member([](auto& s) -> auto& { return s.pipeline.jets.trim_rate; }), has_jets,
              "Rate at which the pressures of several jets on the hand are equalised. 0: off.");
  list.number("buoyancy", "Buoyancy", "m/s²", 0, 5, 0.1,
              member([](auto& s) -> auto& { return s.pipeline.fluid.buoyancy; }), has_smoke,
              "How strongly undiluted smoke rises.");
  list.choice(
      "pressure_of", "Pressure of", kParts,
      member([](auto& s) -> auto& { return s.pipeline.fluid_pressure.part; }), has_smoke,
      "All of the air's pressure, the smoke's share of it, or that of the hand's own movement in "
      "still air. A part takes twice the smoke's time.");
  list.toggle(
      "parts", "Both parts",
      member([](auto& s) -> auto& { return s.pipeline.fluid_pressure.parts; }), has_smoke,
      "Shows and records the forces of the smoke and of the hand's own movement separately, "
      "whichever is felt. It takes twice the smoke's time.");
  list.number(
      "grid", "Grid", "cells", FluidSettings::kLeastCells, FluidSettings::kMostCells, 1,
      member([](auto& s) -> auto& { return s.pipeline.fluid.cells; }), has_smoke,
      "Cells along each edge of the smoke's box. Fewer are coarser and faster. Restarts the "
      "smoke.");
  return list.take();
}

std::vector<RunControl> plan_controls() {
  using S = LiveSettings;
  ControlList list("Plan");
  list.choice(
      "method", "Method", kMethods, member([](auto& s) -> auto& { return s.pipeline.method; }),
      always,
      "PRO-STM moves focal points along closed paths; AM holds them still and modulates them.");
  list.choice(
      "preset", "Preset", kPresets,
      {[](const S& s) { return static_cast<double>(s.pipeline.plan.preset); }, set_preset},
      is_pro_stm,
      "How paths are planned: for the nearest field, by a short search, for what is felt, or by "
      "the paper's own method.");
  list.number("paths", "Paths", "", 1, kMaxPaths, 1,
              {[](const S& s) {
                 return static_cast<double>(is_am(s) ? s.pipeline.am.foci : s.pipeline.plan.paths);
               },
               set_paths},
              always, "Simultaneous focal points, which share the array's power.");
  list.number("speed", "Speed", "m/s", 2, 8, 0.5,
              member([](auto& s) -> auto& { return s.pipeline.plan.speed; }), is_pro_stm,
              "Speed of the focal points. The longest path is the speed divided by the draw rate.");
  list.number("gain", "Gain γ", "", 0.5, 3, 0.1,
              member([](auto& s) -> auto& { return s.pipeline.plan.gain; }), is_pro_stm,
              "Ratio of the rendered pressure to the perceived pressure of a path.");
  list.toggle("array_width", "Array's own width",
              member([](auto& s) -> auto& { return s.pipeline.array_width; }), is_fitted,
              "Presets Best, Fast and Felt use the width of the array's focus at the hand.");
  list.number(
      "sigma", "Width σ", "mm", 4, 20, 0.1,
      {[](const S& s) { return std::round(1e4 * s.pipeline.sigma()) * 0.1; }, set_sigma}, always,
      "Width of a focal point that the planner assumes, unless the array's own width is used.");
  list.number("bending", "Smoothness", "", 0, 0.3, 0.01,
              member([](auto& s) -> auto& { return s.pipeline.plan.fit_bending; }), is_fitted,
              "Cost of bends in a path, for presets Best, Fast and Felt.");
  list.number(
      "strength_weight", "Strength", "", 0, 1, 0.05,
      member([](auto& s) -> auto& { return s.pipeline.plan.strength_weight; }), is_felt,
      "Preset Felt: weight of a stronger percept against a truer shape, when the number of paths "
      "is chosen. Nobody has felt it.");
  list.number("am_felt_weight", "What is felt of AM", "", 0, 1, 0.05,
              member([](auto& s) -> auto& { return s.pipeline.am.felt_weight; }), is_am,
              "Weight of the skin model in the choice of pressures and phases of the focal points. "
              "0 is off. Nobody has felt it.");
  return list.take();
}

std::vector<RunControl> output_controls() {
  ControlList list("Output");
  list.choice("switch", "Take over", kSwitches,
              member([](auto& s) -> auto& { return s.pipeline.emit.switch_at; }), is_pro_stm,
              "Whether a new plan waits until each path's loop ends, or interrupts it.");
  list.number("tilt", "Tilt compensation", "×", 1, 4, 0.1,
              member([](auto& s) -> auto& { return s.pipeline.emit.tilt_bound; }), always,
              "Largest factor on the pressure to compensate for tilted skin; 1 is off.");
  list.number("am_frequency", "Modulation", "Hz", 50, 300, 10,
              member([](auto& s) -> auto& { return s.pipeline.emit.am_frequency; }), is_am,
              "Modulation frequency of the intensity of AM's focal points.");
  list.choice("am_waveform", "Waveform", kWaveforms,
              member([](auto& s) -> auto& { return s.pipeline.emit.am_waveform; }), is_am,
              "Waveform of the modulation.");
  return list.take();
}

std::vector<RunControl> hand_controls() {
  using S = LiveSettings;
  ControlList list("Hand");
  list.choice("source", "Hands from", kSources,
              {[](const S& s) { return place(kSources, s.source); },
               [](S& s, double v) { s.source = chosen(kSources, v); }},
              always, "Source of the hands when the page's own hand is off.", has_source);
  list.toggle("prediction", "Prediction",
              {[](const S& s) { return s.pipeline.track.prediction > 0.0 ? 1.0 : 0.0; },
               [](S& s, double v) {
                 s.pipeline.track.prediction = v != 0.0 ? TrackSettings{}.prediction : 0.0;
               }},
              always, "Extrapolates tracked hands by the latency until they are felt.");
  return list.take();
}

}  // namespace

std::span<const RunControl> run_controls() {
  static const std::vector<RunControl> kControls = [] {
    std::vector<RunControl> all;
    for (const auto& of_group :
         {smoke_controls(), plan_controls(), output_controls(), hand_controls()})
      all.insert(all.end(), of_group.begin(), of_group.end());
    return all;
  }();
  return kControls;
}

int control_index(std::string_view id) {
  const auto all = run_controls();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].id == id) return static_cast<int>(i);
  return -1;
}

double control_number(const RunControl& control, const ControlValue& value,
                      const LiveSettings& settings) {
  std::ostringstream wrong;
  wrong << control.id << " must be ";
  if (control.kind == ControlKind::Switch) {
    if (const bool* on = std::get_if<bool>(&value)) return *on ? 1.0 : 0.0;
    wrong << "true or false";
  } else if (control.kind == ControlKind::Number) {
    const double* number = std::get_if<double>(&value);
    const bool whole = control.step == 1.0;
    if (number != nullptr && *number >= control.low && *number <= control.high &&
        (!whole || *number == std::floor(*number))) {
      return *number;
    }
    wrong << (whole ? "a whole number" : "a number") << " between " << control.low << " and "
          << control.high << (control.unit.empty() ? "" : " ") << control.unit;
  } else {
    const auto* name = std::get_if<std::string>(&value);
    const char* before = "";
    for (std::size_t i = 0; i < control.choices.size(); ++i) {
      if (control.available != nullptr && !control.available(settings, i)) continue;
      if (name != nullptr && *name == control.choices[i].value) return static_cast<double>(i);
      wrong << before << control.choices[i].value;
      before = " or ";
    }
  }
  throw InputError(wrong.str());
}

}  // namespace prostm
