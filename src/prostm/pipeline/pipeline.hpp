#pragma once
/// The one place that knows all stages: hand → world → contact → plan → emit → device.

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

/// The box seen along y, for pictures: x fastest, then z.
struct SideView {
  GridShape grid;                  ///< where the box was
  std::vector<float> density;      ///< nx·nz, the densest along y, 0..1
  std::vector<std::uint8_t> hand;  ///< nx·nz, 1 where there is a hand
};

/// The result of one step of the world: everything that a plan, a recording or a picture needs.
struct WorldFrame {
  std::int64_t step = 0;  ///< steps so far, from 1
  double arrival = 0.0;   ///< of the tracker's frame; run time [s]
  double due = 0.0;       ///< when the step was to take the hands; run time [s]
  double taken = 0.0;     ///< when it took them; run time [s]
  HandFrame hands;        ///< filtered, in D
  bool targeted = false;  ///< a plan update follows this step: `target` and `contact` are of now
  TargetFrame target;
  std::optional<PlacedStimulus> stimulus;  ///< that the target should be, if there is any
  SideView side;                           ///< when settings.side_view
  ContactStats contact_stats;
  double track_time = 0, hand_time = 0, meet_time = 0, contact_time = 0;  ///< [s]
  double world_time = 0;  ///< of the whole step; meet_time is what came after the hands [s]
};

/// Hand, world and skin: the stages that run at the world's rate.
class WorldStage {
 public:
  /// @param world that the hands meet; null: the one that the settings name, of `kinds`.
  /// @throws std::invalid_argument with a sentence.
  WorldStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
             std::unique_ptr<World> world = nullptr,
             std::span<const WorldKind> kinds = world_kinds());

  /// Step `step` (from 1) with the hands at run time `time` [s], dt after the last one; makes
  /// targets on every `steps_per_plan`th. Writes `due` = `taken` = time.
  void run(std::int64_t step, double time, double dt, WorldFrame& out);

  /// The same in parts, to the bit. prepare() does what needs no hands. take() samples them at run
  /// time `time` [s]; it may be repeated if a newer frame may arrive. meet() goes from the hands to
  /// the targets; it puts the hands back along their velocities to where they were when the step
  /// was due, so that the world's steps stay even. settle() runs off the critical path. @pre called
  /// in this order, or take() before prepare(); dt the same.
  void prepare(double dt);
  void take(double time, WorldFrame& out);
  void meet(std::int64_t step, double due, double dt, WorldFrame& out);
  void settle();

  /// Whether a step makes targets.
  bool targets(std::int64_t step) const { return step % steps_per_plan_ == 0; }

  // between steps of a run that is steered
  /// Takes the hands of another stage, and the compatible state of its world.
  void adopt(WorldStage& other);
  void set_hands(std::unique_ptr<HandSource> hands) { hands_ = std::move(hands); }
  void set_tracker_pose(const Pose& X_DT) { X_DT_ = X_DT; }
  const Pose& tracker_pose() const { return X_DT_; }
  void set_steps_per_plan(int steps) { steps_per_plan_ = steps; }
  /// From now on take() says there whether hands are there (MuteReason::NoHand).
  void tell(std::shared_ptr<Mute> mute) { mute_ = std::move(mute); }

  const WorldStats& world_stats() const { return world_stats_; }  ///< of the last whole step
  const World& world() const { return *world_; }
  std::size_t max_cells() const { return contact_.max_cells(); }
  HandSource& hands() { return *hands_; }
  const HandSource& hands() const { return *hands_; }

 private:
  std::unique_ptr<HandSource> hands_;
  std::shared_ptr<Mute> mute_;  // none without a clock
  HandFilter filter_;
  Pose X_DT_;
  WorkerPool pool_;
  std::unique_ptr<World> world_;
  HandRasteriser rasteriser_;
  SkinContact contact_;
  WorldStats world_stats_;
  double world_time_ = 0.0;   // of the world, since the last meet() [s]
  double since_taken_ = 0.0;  // of the world, since the hands were taken [s]
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
  double start = 0.0;                       ///< of the update; run time [s]
  double plan_time = 0.0, lift_time = 0.0;  ///< [s]
  double max_skin_length = 0.0;             ///< longest path on the skin [m]
  /// Emission of the plan; speeds, periods and loop of `plan` are these.
  PlayedPlan played;
  double full_scale_pressure = 0.0;  ///< rendered, at intensity 1 [Pa]
  double emission_rate = 0.0;        ///< samples of the emission [Hz]
  /// σ that each patch was planned with, if there is a plan [m].
  std::array<double, kMaxPatches> sigma = {};
  /// Whether the target is the stimulus that it should be; nothing where nothing is asked of it.
  std::optional<GateResult> gate;
};

/// Paths or foci from targets: the stages that run at the planner's rate.
class PlanStage {
 public:
  /// @param max_cells of a target raster.  @param full_scale of the scene, where the settings give
  /// none [Pa].  @param device that plays the emission.  @param levels of its array; null:
  /// made from the settings.
  /// @throws std::invalid_argument with a sentence.
  PlanStage(const PipelineSettings& settings, std::size_t max_cells, double full_scale,
            const DeviceInfo& device, std::shared_ptr<const SafetyLevels> levels);

  /// Plans a target and hands the result to the emitter; without a plan the output fades. Writes
  /// `start` = `taken` of the target.
  void run(const WorldFrame& contact, PlanFrame& out);

  /// Counts on from the updates of a stage that this one stands in for.
  void continue_from(const PlanStage& other) { updates_ = other.updates_; }

  /// Emitter and limiter fall silent while this is on. @pre nothing plays.
  void obey(const std::shared_ptr<Mute>& mute);
  /// Lets somebody look at what leaves for the device. @pre nothing plays.
  void show(SoundWatch& watch) { samples_->show(watch); }

  Emitter& emitter() { return *emitter_; }
  /// The emission as the device takes it.
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

/// The whole line on the caller's thread, without a clock: tests, studies and Python step it. A
/// runner may instead drive its stages from threads of its own; a pipeline is used in one of the
/// two ways.
class Pipeline {
 public:
  /// @param mute what else silences the output; not null. In real time it is also on while a step
  /// finds no hand, so that the output does not wait for the next plan to fade.
  /// @param device that plays; null: the one that the settings name.
  /// @param world that the hands meet; null: the one that the settings name, of `kinds`.
  /// @param kinds table of worlds; it outlives the pipeline.
  /// @throws std::invalid_argument with a sentence.
  Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
           std::shared_ptr<Mute> mute = std::make_shared<Mute>(),
           std::unique_ptr<Device> device = nullptr, std::unique_ptr<World> world = nullptr,
           std::span<const WorldKind> kinds = world_kinds());

  /// The device stops at once; silence() before is what spares the skin a click.
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// One step of dt [s]: the device plays up to it, then the line runs top to bottom. True
  /// when a plan update came with it: see plan(). @pre the device keeps no time of its own.
  bool step(double dt);

  const WorldFrame& contact() const { return contact_frame_; }
  const PlanFrame& plan() const { return plan_frame_; }
  double time() const { return time_; }  ///< run time [s]
  /// As reconfigure() took them last. @pre on the thread that calls it.
  const PipelineSettings& settings() const { return settings_; }

  /// Takes other settings between two steps, and rebuilds what they concern: hands stay, and so
  /// does the compatible state of the world. Where plans or their emission change the device
  /// starts anew, so that its samples count from 0. Not taken: another world_rate, array or device,
  /// and nothing of hands, world and contact where the world is the caller's own.
  /// @throws std::invalid_argument with a sentence; then everything is as it was.
  void reconfigure(const PipelineSettings& settings);

  /// Begins to fade the output out, and lets no plan sound after it. Any thread.
  void mute_for_good() noexcept { mute_->set(MuteReason::Ended, true); }
  /// Fades the output out and stops the device, once its end is read by who reads sound(). @pre no
  /// other thread uses the pipeline.
  void silence();

  WorldStage& world_stage() { return *world_stage_; }
  PlanStage& plans() { return *plans_; }
  Device& device() { return *device_; }
  /// When the device's output begins and ends.
  SoundWatch& sound() { return sound_; }
  DeviceStats device_stats() const;  ///< over all starts of the device
  EmitStats emit_stats() const;      ///< of all emitters that there were
  SafetyStats safety_stats() const;  ///< of all limiters that there were

  /// Mutes while the device says that it is hot, and until it has not for a second. One thread.
  /// @param time of the clock, or of the run [s].
  void watch_heat(double time);

 private:
  /// In real time, so that nothing clicks when the device stops, or plays on.
  void fade_out();
  /// The device plays another emitter, after the fade of the one before. @return why it cannot, and
  /// plays the one before; or nothing.
  std::string restart(PlanStage& plans);

  PipelineSettings settings_;
  std::shared_ptr<Mute> mute_;
  const bool own_world_;  // the caller's
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

/// Lets a device that keeps no time play everything that is due at run time `time` [s].
void play_until(Device& device, double time);

}  // namespace prostm
