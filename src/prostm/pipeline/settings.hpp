#pragma once
/// The settings of every stage, in one place.

#include <memory>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/contact/skin_contact.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/device/device_kind.hpp"
#include "prostm/device/safety/safety_limiter.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/smoke/box_follow.hpp"
#include "prostm/pipeline/smoke/jet_trim.hpp"
#include "prostm/plan/method.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

inline constexpr double kLiveBudget = 2e-3;  ///< for a plan of preset best in real time [s]

struct PipelineSettings {
  std::string world = "smoke";      ///< what presses on the hands, see world_kinds()
  std::string scene = "one-plume";  ///< of the world, by name
  Method method = Method::ProStm;
  std::string device = "sim";                      ///< what plays, see device_named()
  std::string array = array_kinds().front().name;  ///< what `transducers` are: a name or a file
  /// Plans of presets best and fast count on the width of the array's focus, not on [plan] sigma.
  bool array_width = false;
  std::string tracker = "centre";  ///< what `X_DT` is, by name: centre, a kit or a file
  double world_rate = 50.0;        ///< steps of the world a second [Hz]
  int world_steps_per_plan = 0;    ///< a plan every so many of them; 0: as the method asks, 2
                                   ///< (25 Hz) of pro-stm, 1 (50 Hz) of am
  /// In real time, a step that makes targets waits so long at most for a tracker's frame that comes
  /// in after the step was due [s]; 0 to 0.1, at most half a step.
  double frame_wait = 0.010;
  bool side_view = false;  ///< keep a picture of the box from the side with every plan update
  int threads = 2;         ///< of the world, the stepping thread included

  TrackSettings track;
  ScriptedHandSettings scripted_hand;
  StudyHandSettings study_hand;
  FluidSettings fluid;
  BoxSettings box;
  JetSettings jets;
  FluidPressureSettings fluid_pressure;  ///< in files with `contact`
  ContactSettings contact;
  PlanSettings plan;
  AmSettings am;
  EmitSettings emit;
  SafetySettings safety;
  DeviceSettings devices;                     ///< of all kinds, each under a name of its own
  TransducerArray transducers = usx_array();  ///< not a field in files: `array` names them
  Pose X_DT = default_tracker_pose();         ///< pose of the tracker; `tracker` names it

  /// world_steps_per_plan, where 0 stands for what the method asks.
  int steps_per_plan() const;

  /// Returns the setup that `device` is made from.
  DeviceSetup device_setup() const {
    return {.array = transducers, .address = {}, .foci = emit.foci, .settings = devices};
  }

  /// The device that these settings name, before it is made.
  DeviceInfo device_info() const;
  /// Samples of an emission for it [Hz].
  double emission_rate() const { return device_info().emission_rate(); }

  /// The fall-off of a focal point that the method counts on [m].
  double sigma() const;
  /// The fields of this struct that belong to no stage.
  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// Gives plans of preset best their time in real time, where no budget was chosen: a clock is
/// running, so the planner gets a share of an update, not a number of tries.
void set_live_budget(PipelineSettings& settings);

/// The planner's settings with what an emission of so many samples a second can play, (P18).
PlanSettings playable_plan_settings(const PipelineSettings& settings, double emission_rate);
/// The same with the widths that `array_width` asks for: those of `plan`, or else (A22) of
/// `transducers`.
PlanSettings plan_settings(const PipelineSettings& settings, double emission_rate);
/// Settings of the planner of AM, with the frequency of the modulation and, where what is felt
/// counts, the table of σ of plan_settings().
AmSettings am_settings(const PipelineSettings& settings, double emission_rate);

/// The levels that the array of the settings can reach, for its limiter.
std::shared_ptr<const SafetyLevels> levels_of(const PipelineSettings& settings);

/// The largest Σ intensity² that is emitted: [emit] power_limit within the cap of [safety].
double power_limit(const PipelineSettings& settings);

/// The emission's settings, with a full scale: where they give none, γ times `largest`, the largest
/// pressure that is to be rendered [Pa]. Its power limit is power_limit().
EmitSettings emit_settings(const PipelineSettings& settings, double largest);

/// Every stage's settings under its name in files: "pipeline", "track", "scripted_hand", "fluid", …
std::vector<SettingsGroup> settings_groups(PipelineSettings& settings);
/// The same to read alone.
std::vector<SettingsGroup> settings_groups(const PipelineSettings& settings);
/// The settings as studies compare them and make checksums of them: all, except `world` where it is
/// the default, so that studies from before there was a choice are still the same.
std::vector<SettingsGroup> study_settings_groups(const PipelineSettings& settings);

}  // namespace prostm
