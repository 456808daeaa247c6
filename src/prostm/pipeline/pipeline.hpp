#pragma once
/// The pipeline of all stages: hand → world → contact → plan → emit → device.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "prostm/contact/skin_contact.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/played_plan.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/world.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

/// The box seen along y, for pictures. Arrays are x fastest, then z.
struct SideView {
  GridShape grid;                  ///< position of the box
  std::vector<float> density;      ///< nx·nz, largest density along y, 0..1
  std::vector<std::uint8_t> hand;  ///< nx·nz, 1 in hands
};

/// The result of one step of the world: everything that a plan, a recording or a picture needs.
struct WorldFrame {
  std::int64_t step = 0;  ///< steps so far, from 1
  double arrival = 0.0;   ///< arrival of the tracker's frame; run time [s]
  double due = 0.0;       ///< time at which the step should take the hands; run time [s]
  double taken = 0.0;     ///< time at which it took them; run time [s]
  HandFrame hands;        ///< filtered, in D
  bool targeted = false;  ///< a plan update follows this step, and the target is current
  TargetFrame target;
  std::optional<PlacedStimulus> stimulus;  ///< stimulus that the target should be, if any
  SideView side;                           ///< set only with settings.side_view
  ContactStats contact_stats;
  double track_time = 0, hand_time = 0, meet_time = 0, contact_time = 0;  ///< [s]
  double world_time = 0;  ///< of the whole step [s]; meet_time is the part after the hands
};

/// Hand, world and skin: the stages that run at the world's rate.
class WorldStage {
 public:
  /// @param world the world that the hands meet; null: the one named by the settings, from `kinds`.
  /// @throws std::invalid_argument with a sentence.
  WorldStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
             std::unique_ptr<World> world = nullptr,
             std::span<const WorldKind> kinds = world_kinds());

  /// Computes step `step` (from 1) with the hands at run time `time` [s], dt after the previous
  /// one; every `steps_per_plan`th step makes targets. Writes `due` = `taken` = time.
  void run(std::int64_t step, double time, double dt, WorldFrame& out);

  /// run() in parts, with bit-identical results. prepare() does the work that needs no hands.
  /// take() samples the hands at run time `time` [s]; it may be repeated if a newer frame may
  /// arrive. meet() computes targets from the hands, after moving them back along their velocities
  /// to the time at which the step was due, so that the world's steps are uniform. settle() runs
  /// off the critical path. @pre called in this order, or take() before prepare(); dt the same.
  void prepare(double dt);
  void take(double time, WorldFrame& out);
  void meet(std::int64_t step, double due, double dt, WorldFrame& out);
  void settle();

  /// Whether a step makes targets.
  bool targets(std::int64_t step) const { return step % steps_per_plan_ == 0; }

  // between steps of a live run
  /// Takes the hands of another stage, and the compatible state of its world.
  void adopt(WorldStage& other);
  void set_hands(std::unique_ptr<HandSource> hands) { hands_ = std::move(hands); }
  void set_tracker_pose(const Pose& X_DT) { X_DT_ = X_DT; }
  const Pose& tracker_pose() const { return X_DT_; }
  void set_steps_per_plan(int steps) { steps_per_plan_ = steps; }
  /// From now on, take() sets MuteReason::NoHand there when there is no hand.
  void tell(std::shared_ptr<Mute> mute) { mute_ = std::move(mute); }

  const WorldStats& world_stats() const { return world_stats_; }  ///< of the last complete step
  const World& world() const { return *world_; }
  std::size_t max_cells() const { return contact_.max_cells(); }
  HandSource& hands() { return *hands_; }
  const HandSource& hands() const { return *hands_; }

 private:
  std::unique_ptr<HandSource> hands_;
  std::shared_ptr<Mute> mute_;  // null without a clock
  HandFilter filter_;
  Pose X_DT_;
  WorkerPool pool_;
  std::unique_ptr<World> world_;
  HandRasteriser rasteriser_;
  SkinContact contact_;
  WorldStats world_stats_;
  double world_time_ = 0.0;   // world's computing time since the last meet() [s]
  double since_taken_ = 0.0;  // world's computing time since the hands were taken [s]
  void view_from_side(SideView& out) const;
  int steps_per_plan_;
  bool side_view_;
};

/// The result of one plan update.
struct PlanFrame {
  std::int64_t id = 0;  ///< counts updates from 1
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  double start = 0.0;                       ///< start of the update; run time [s]
  double plan_time = 0.0, lift_time = 0.0;  ///< [s]
  double max_skin_length = 0.0;             ///< longest path on the skin [m]
  /// Emission of the plan; speeds, periods and loop of `plan` agree with it.
  PlayedPlan played;
  double full_scale_pressure = 0.0;  ///< rendered, at intensity 1 [Pa]
  double emission_rate = 0.0;        ///< sample rate of the emission [Hz]
  /// σ used for planning each patch, if there is a plan [m].
  std::array<double, kMaxPatches> sigma = {};
  /// Whether the target is the intended stimulus; nothing if none is intended.
  std::optional<GateResult> gate;
};

/// Computes paths or foci from targets: the stages that run at the planner's rate.
class PlanStage {
 public:
  /// @param max_cells largest size of a target raster. @param full_scale full scale of the scene,
  /// used if the settings give none [Pa]. @param device the device that plays the emission. @param
  /// levels the levels of its array; null: computed from the settings.
  /// @throws std::invalid_argument with a sentence.
  PlanStage(const PipelineSettings& settings, std::size_t max_cells, double full_scale,
            const DeviceInfo& device, std::shared_ptr<const SafetyLevels> levels);

  /// Plans a target and submits the result to the emitter; without a plan the output fades. Writes
  /// `start` = `taken` of the target.
  void run(const WorldFrame& contact, PlanFrame& out);

  /// Continues the update counter of the stage that this one replaces.
  void continue_from(const PlanStage& other) { updates_ = other.updates_; }

  /// Makes emitter and limiter silent while `mute` is on. @pre nothing plays.
  void obey(const std::shared_ptr<Mute>& mute);
  /// Lets `watch` observe the samples sent to the device. @pre nothing plays.
  void show(SoundWatch& watch) { samples_->show(watch); }

  Emitter& emitter() { return *emitter_; }
  /// The emission as a source of samples for the device.
  SampleChain& samples() { return *samples_; }
  double full_scale_pressure() const {
    return emit_settings_.full_scale_pressure;
  }  ///< rendered, at intensity 1 [Pa]

 private:
  std::variant<Planner, AmPlanner> planner_;
  EmitSettings emit_settings_;
  double emission_rate_, max_speed_;  // [Hz], [m/s]
  StimulusGate gate_;
  std::unique_ptr<Emitter> emitter_;
  std::unique_ptr<SampleChain> samples_;
  std::int64_t updates_ = 0;
};

/// The whole pipeline on the caller's thread, without a clock, as used by tests, studies and
/// Python. Alternatively, a runner drives its stages from threads of its own; use a pipeline in
/// only one of the two ways.
class Pipeline {
 public:
  /// @param mute silences the output; not null. In real time it is also on while there is no hand,
  /// so that the output fades without waiting for the next plan.
  /// @param device the device that plays; null: the one named by the settings.
  /// @param world the world that the hands meet; null: the one named by the settings, from `kinds`.
  /// @param kinds table of worlds; must outlive the pipeline.
  /// @throws std::invalid_argument with a sentence.
  Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
           std::shared_ptr<Mute> mute = std::make_shared<Mute>(),
           std::unique_ptr<Device> device = nullptr, std::unique_ptr<World> world = nullptr,
           std::span<const WorldKind> kinds = world_kinds());

  /// Stops the device at once. Call silence() first to avoid a click on the skin.
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Computes one step of dt [s]: the device plays up to it, then all stages run in order. Returns
  /// true if the step included a plan update, see plan(). @pre the device does not keep its own
  /// time.
  bool step(double dt);

  const WorldFrame& contact() const { return contact_frame_; }
  const PlanFrame& plan() const { return plan_frame_; }
  double time() const { return time_; }  ///< run time [s]
  /// The settings last accepted by reconfigure(). @pre called on the same thread.
  const PipelineSettings& settings() const { return settings_; }

  /// Applies other settings between two steps, and rebuilds the affected stages. Hands and the
  /// compatible state of the world are kept. If plans or their emission change, the device
  /// restarts, and its samples count from 0. Not applied: changes of world_rate, array and device,
  /// and, if the world is the caller's own, of hands, world and contact. @throws
  /// std::invalid_argument with a sentence; nothing has changed then.
  void reconfigure(const PipelineSettings& settings);

  /// Fades the output out permanently. Thread-safe.
  void mute_for_good() noexcept { mute_->set(MuteReason::Ended, true); }
  /// Fades the output out and stops the device, after the reader of sound() has seen the end of
  /// output. @pre no other thread uses the pipeline.
  void silence();

  WorldStage& world_stage() { return *world_stage_; }
  PlanStage& plans() { return *plans_; }
  Device& device() { return *device_; }
  /// Reports the beginning and end of the device's output.
  SoundWatch& sound() { return sound_; }
  DeviceStats device_stats() const;  ///< over all starts of the device
  EmitStats emit_stats() const;      ///< over all emitters so far
  SafetyStats safety_stats() const;  ///< over all limiters so far

  /// Mutes while the device reports that it is hot, and for a second afterwards. Not thread-safe.
  /// @param time clock, or run time [s].
  void watch_heat(double time);

 private:
  /// Fades out in real time, so that nothing clicks when the device stops or changes its emitter.
  void fade_out();
  /// Switches the device to another emitter, after fading out the current one. @return empty, or
  /// the reason why it failed and the device plays the current one again.
  std::string restart(PlanStage& plans);

  PipelineSettings settings_;
  std::shared_ptr<Mute> mute_;
  const bool own_world_;  // whether the world is the caller's
  const std::span<const WorldKind> kinds_;
  std::shared_ptr<const SafetyLevels> levels_;
  std::unique_ptr<WorldStage> world_stage_;
  std::unique_ptr<Device> device_;
  SoundWatch sound_;
  std::unique_ptr<PlanStage> plans_;
  DeviceStats device_before_;
  EmitStats emit_before_;
  SafetyStats safety_before_;
  double cool_at_ = 0.0;  // [s]
  WorldFrame contact_frame_;
  PlanFrame plan_frame_;
  std::int64_t steps_ = 0;
  double time_ = 0.0;
};

/// Makes a device that does not keep its own time play up to run time `time` [s].
void play_until(Device& device, double time);

}  // namespace prostm
