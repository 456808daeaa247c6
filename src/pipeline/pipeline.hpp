#pragma once
/// The one place that knows all stages: hand → fluid → contact → plan → emit → device.

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "contact/skin_contact.hpp"
#include "core/worker_pool.hpp"
#include "device/simulated_array.hpp"
#include "emit/emitter.hpp"
#include "fluid/fluid.hpp"
#include "hand/hand_raster.hpp"
#include "pipeline/settings.hpp"
#include "plan/planner.hpp"
#include "track/hand_source.hpp"

namespace prostm {

/// The box seen along y, for pictures: x fastest, then z.
struct SideView {
  std::vector<float> smoke;        ///< nx·nz, the densest along y, 0..1
  std::vector<std::uint8_t> hand;  ///< nx·nz, 1 where there is a hand
};

/// What one fluid step left behind: everything that a plan, a recording or a picture needs.
struct ContactFrame {
  std::int64_t step = 0;  ///< fluid steps so far, from 1
  double arrival = 0.0;   ///< of its hands: run time, or the steady clock in a real-time run [s]
  HandFrame hands;        ///< filtered, in D
  bool targeted = false;  ///< a plan update follows this step: `target` and `contact` are of now
  TargetFrame target;
  SideView side;  ///< when settings.side_view
  FluidStats fluid;
  ContactStats contact;
  double track_time = 0, hand_time = 0, fluid_time = 0, contact_time = 0;  ///< [s]
};

/// Hand, smoke and skin: the stages that run at the fluid's rate.
class SmokeStage {
 public:
  /// @throws std::invalid_argument with a sentence.
  SmokeStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands);

  /// Fluid step `step` (from 1) with the hands at run time `time` [s], dt after the last one; makes
  /// targets on every `steps_per_plan`th. Writes `arrival` = time.
  void run(std::int64_t step, double time, double dt, ContactFrame& out);

  const Fluid& fluid() const { return fluid_; }
  const Scene& scene() const { return scene_; }
  std::size_t max_cells() const { return contact_.max_cells(); }
  HandSource& hands() { return *hands_; }

 private:
  std::unique_ptr<HandSource> hands_;
  HandFilter filter_;
  Pose X_DT_;
  Scene scene_;
  WorkerPool pool_;
  Fluid fluid_;
  HandRasteriser rasteriser_;
  SkinContact contact_;
  void view_from_side(SideView& out) const;
  int steps_per_plan_;
  bool side_view_;
};

/// What one plan update left behind.
struct PlanFrame {
  std::int64_t id = 0;  ///< counts updates from 1
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  double lift_time = 0.0;        ///< [s]
  double max_skin_length = 0.0;  ///< longest path on the skin [m]
};

/// Paths or foci from targets: the stages that run at the planner's rate.
class PlanStage {
 public:
  /// @param max_cells of a target raster.  @param full_scale of the scene, where the settings give
  /// none [Pa].
  /// @throws std::invalid_argument with a sentence.
  PlanStage(const PipelineSettings& settings, std::size_t max_cells, double full_scale);

  /// Plans a target and hands the result to the emitter; without a plan the output fades.
  void run(const ContactFrame& contact, PlanFrame& out) noexcept;

  Emitter& emitter() { return *emitter_; }
  double full_scale_pressure() const {
    return emit_settings_.full_scale_pressure;
  }  ///< rendered, at intensity 1 [Pa]

 private:
  std::variant<Planner, AmPlanner> planner_;
  EmitSettings emit_settings_;
  std::unique_ptr<Emitter> emitter_;
  std::int64_t updates_ = 0;
};

/// The whole line on the caller's thread, without a clock: tests, studies and Python step it. A
/// runner may instead drive its stages from threads of its own; a pipeline is used in one of the
/// two ways.
class Pipeline {
 public:
  /// @throws std::invalid_argument with a sentence.
  Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands);

  /// One fluid step of dt [s]: the device plays up to it, then the line runs top to bottom. True
  /// when a plan update came with it: see plan(). @pre settings.simulated_array.realtime is false.
  bool step(double dt);

  const ContactFrame& contact() const { return contact_frame_; }
  const PlanFrame& plan() const { return plan_frame_; }
  double time() const { return time_; }  ///< run time [s]

  SmokeStage& smoke() { return smoke_; }
  PlanStage& plans() { return plans_; }
  SimulatedArray& device() { return device_; }

 private:
  SmokeStage smoke_;
  PlanStage plans_;
  SimulatedArray device_;
  ContactFrame contact_frame_;
  PlanFrame plan_frame_;
  std::int64_t steps_ = 0;
  double time_ = 0.0;
};

/// Lets a device without a clock play everything that is due at run time `time` [s].
void play_until(SimulatedArray& device, double time);

}  // namespace prostm
