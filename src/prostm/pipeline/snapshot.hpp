#pragma once
/// The state of a run for viewers: copies, published without blocking (docs/design/viewer.md).

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "prostm/core/latest.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/realtime/advice.hpp"
#include "prostm/score/score.hpp"
#include "prostm/track/live/page_hand.hpp"

namespace prostm {

inline constexpr int kVolumeViewCells = 32;  ///< along each edge

/// The density in the world's box, in n³ cells, at most kVolumeViewCells along an edge, from 0
/// (clear) to 255; x fastest, then y, then z.
struct VolumeView {
  int n = 0;                 ///< cells along an edge
  Vec3 p_DF = Vec3::Zero();  ///< corner of the box [m]
  double edge = 0.0;         ///< of the box [m]
  std::vector<std::uint8_t> density;
};

/// Averages the world's density over blocks of cells. Allocates only while `out` grows. @pre the
/// rows of the world have a density.
void view_volume(const World& world, VolumeView& out);

/// One step of the world.
struct StepSnapshot {
  std::int64_t step = 0;
  double time = 0.0;             ///< run time of its hands [s]
  HandFrame hands;               ///< filtered, in D
  Pose X_DT = Pose::Identity();  ///< tracker pose used for them
  double recording_time =
      std::numeric_limits<double>::quiet_NaN();          ///< NaN without a recording [s]
  double track_time = 0, hand_time = 0, world_time = 0;  ///< [s]
};

/// One plan update.
struct PlanSnapshot {
  std::int64_t id = 0;
  std::int64_t step = 0;  ///< step of the world whose target was planned
  bool planned = false;
  TargetFrame target;
  Plan plan;
  PlayedPlan played;                                      ///< emission of the plan
  std::shared_ptr<const PipelineSettings> settings;       ///< settings used for planning
  double full_scale_pressure = 0.0;                       ///< rendered pressure at intensity 1 [Pa]
  double emission_rate = 0.0;                             ///< sample rate of the emission [Hz]
  std::optional<GateResult> gate;                         ///< verdict on the target
  double contact_time = 0, plan_time = 0, lift_time = 0;  ///< [s]
  double latency =
      std::numeric_limits<double>::quiet_NaN();  ///< latency of the last emitted plan [s]
};

/// Counters and state of the run, updated a few dozen times per second.
struct RunSnapshot {
  double time = 0.0;                         ///< run time [s]
  double world_rate = 0.0, plan_rate = 0.0;  ///< over the last second [Hz]
  bool paused = false, fading = false;
  bool device_lost = false;  ///< the device has vanished; it may come back
  PageHandReport page_hand;
  Advice advice;       ///< None while the rates are held
  DeviceStats device;  ///< since the start of the run, like emit
  EmitStats emit;
  double full_scale_pressure = 0.0;  ///< [Pa]
  double intensity = 0.0;            ///< current intensity of the strongest focal point, 0..1

  bool page_hand_in_charge() const { return page_hand.state == PageHandState::Held; }
};

/// Passes snapshots from the threads of a run to a viewer's thread. Functions are grouped by
/// thread.
class Snapshots {
 public:
  // ---- the world's thread ----
  /// Publishes a step that has met its hands.
  void step(const WorldFrame& frame, const WorldStage& stage);
  /// Publishes the density in the box of a settled world, while there are viewers.
  void volume(const World& world);

  // ---- the planner's thread ----
  /// Publishes an update. @param latency the latency of the last emitted plan [s]; NaN without one.
  void plan(const WorldFrame& contact, const PlanFrame& plan, double latency);

  // ---- the thread that called run() ----
  /// Sets the settings of all later plans, with the widths of the array's focus if `array_width` is
  /// set. @pre the planner's thread is not running.
  void use(std::shared_ptr<const PipelineSettings> settings) { settings_ = std::move(settings); }
  RunSnapshot& run_draft() { return run_.draft(); }
  void publish_run() { run_.publish(); }
  bool watched() const { return watched_.load(std::memory_order_relaxed); }

  // ---- the viewer's thread ----
  void watch(bool somebody) { watched_.store(somebody, std::memory_order_relaxed); }
  bool refresh_step() { return step_.refresh(); }
  const StepSnapshot& step() const { return step_.value(); }
  bool refresh_volume() { return volume_.refresh(); }
  const VolumeView& volume() const { return volume_.value(); }
  bool refresh_plan() { return plan_.refresh(); }
  const PlanSnapshot& plan() const { return plan_.value(); }
  bool refresh_run() { return run_.refresh(); }
  const RunSnapshot& run() const { return run_.value(); }
  /// Takes the oldest unread latency; false if all were read.
  bool next_latency(double& out) { return latencies_.pop(out); }

 private:
  std::atomic<bool> watched_{false};
  Latest<StepSnapshot> step_;
  Latest<VolumeView> volume_;
  Latest<PlanSnapshot> plan_;
  Latest<RunSnapshot> run_;
  SpscRing<double> latencies_{256};  // drops new values when full: there is no viewer then
  std::shared_ptr<const PipelineSettings> settings_;
};

/// The field that a plan renders on its target as played, by Eq. (1) with the plan's own width.
struct RenderedPlan {
  std::array<std::vector<double>, kMaxPatches>
      field;                   ///< field of each patch, in the unit of the target
  Metrics metrics;             ///< metrics of the patch with the most pressure
  int patch = 0;               ///< index of that patch
  double sigma = 0.0;          ///< width used for field and metrics [m]
  Metrics metrics_at_setting;  ///< metrics at [plan] sigma
  double max_target = 0.0;     ///< over all patches [Pa]
  /// total forces of the target, of the smoke and of the hands' own movement [N]; the latter two
  /// are NaN if the world does not compute them
  double force = 0.0, smoke_force = 0.0, movement_force = 0.0;
};

/// Renders a plan. For the viewer's thread: takes about as long as planning.
void render(const PlanSnapshot& plan, RenderedPlan& out);

}  // namespace prostm
