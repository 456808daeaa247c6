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

struct PipelineSettings {
  std::string world = "smoke";      ///< name of the world, see world_kinds()
  std::string scene = "one-plume";  ///< name of a scene of the world
  Method method = Method::ProStm;
  std::string device = "sim";                      ///< name of the device, see device_named()
  std::string array = array_kinds().front().name;  ///< name or file of `transducers`
  /// Whether presets best, fast and felt assume the width of the array's focus instead of [plan]
  /// sigma.
  bool array_width = false;
  std::string tracker = "centre";  ///< origin of `X_DT`: centre, a kit or a file
  double world_rate = 50.0;        ///< steps of the world per second [Hz]
  int world_steps_per_plan = 0;    ///< steps of the world per plan; 0: default of the method, 2 (25
                                   ///< Hz) for pro-stm, 1 (50 Hz) for am
  /// Longest time that a real-time step with targets waits for a tracker's frame after the step was
  /// due [s]; 0 to 0.1, at most half a step.
  double frame_wait = 0.010;
  bool side_view = false;  ///< record a side view of the box with every plan update
  int threads = 2;         ///< threads of the world, including the stepping thread

  TrackSettings track;
  ScriptedHandSettings scripted_hand;
  StudyHandSettings study_hand;
  FluidSettings fluid;
  BoxSettings box;
  JetSettings jets;
  FluidPressureSettings fluid_pressure;  ///< in files under `contact`
  ContactSettings contact;
  PlanSettings plan;
  AmSettings am;
  EmitSettings emit;
  SafetySettings safety;
  DeviceSettings devices;  ///< settings of all kinds of devices, under their own names
  TransducerArray transducers = usx_array();  ///< not stored in files: `array` names them
  Pose X_DT = default_tracker_pose();         ///< pose of the tracker; `tracker` names it

  /// world_steps_per_plan, with 0 replaced by the method's default.
  int steps_per_plan() const;

  /// Returns the setup for making `device`.
  DeviceSetup device_setup() const {
    return {.array = transducers, .address = {}, .foci = emit.foci, .settings = devices};
  }

  /// Information on the device named by these settings, before it is made.
  DeviceInfo device_info() const;
  /// Sample rate of an emission for that device [Hz].
  double emission_rate() const { return device_info().emission_rate(); }

  /// Width σ of a focal point that the method assumes [m].
  double sigma() const;
  /// Visits the fields of this struct that belong to no stage.
  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// Sets the preset's time budget for real time, unless a budget was chosen: the planner then gets a
/// share of an update instead of a number of evaluations.
void set_live_budget(PipelineSettings& settings);

/// The planner's settings, limited to what an emission at this rate can play, (P18).
PlanSettings playable_plan_settings(const PipelineSettings& settings, double emission_rate);
/// The same, with the widths required by `array_width`: those of `plan`, or else (A22) of
/// `transducers`.
PlanSettings plan_settings(const PipelineSettings& settings, double emission_rate);
/// Settings of the AM planner, with the modulation frequency and, if there is a felt weight, the
/// table of σ of plan_settings().
AmSettings am_settings(const PipelineSettings& settings, double emission_rate);

/// The levels that the array can reach, for the limiter.
std::shared_ptr<const SafetyLevels> levels_of(const PipelineSettings& settings);

/// The largest Σ intensity² of the emission: [emit] power_limit within the cap of [safety].
double power_limit(const PipelineSettings& settings);

/// The emission's settings with a full scale: if they give none, γ times `largest`, the largest
/// pressure to render [Pa]. The power limit is power_limit().
EmitSettings emit_settings(const PipelineSettings& settings, double largest);

/// Every stage's settings under its name in files: "pipeline", "track", "scripted_hand", "fluid", …
std::vector<SettingsGroup> settings_groups(PipelineSettings& settings);
/// The same, read-only.
std::vector<SettingsGroup> settings_groups(const PipelineSettings& settings);
/// The settings used by studies for comparisons and checksums: all, except a default `world`, for
/// compatibility with studies from before `world` existed.
std::vector<SettingsGroup> study_settings_groups(const PipelineSettings& settings);

}  // namespace prostm
