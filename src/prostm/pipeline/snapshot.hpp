#pragma once
/// The state of a run for those who watch it: copies, published without
/// blocking (docs/design/viewer.md).

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

/// The density in the world's box, in n³ cells, at most kVolumeViewCells along an edge, 0 clear to
/// 255: x fastest, then y, then z.
struct VolumeView {
  int n = 0;                 ///< cells along an edge
  Vec3 p_DF = Vec3::Zero();  ///< corner of the box [m]
  double edge = 0.0;         ///< of the box [m]
  std::vector<std::uint8_t> density;
};

/// Averages the world's density over blocks of cells. Allocates only while `out` grows. @pre the
/// world's rows have a density.
void view_volume(const World& world, VolumeView& out);

/// One step of the world.
struct StepSnapshot {
  std::int64_t step = 0;
  double time = 0.0;                                                 ///< of its hands, run time [s]
  HandFrame hands;                                                   ///< filtered, in D
  Pose X_DT = Pose::Identity();                                      ///< that put them there
  double recording_time = std::numeric_limits<double>::quiet_NaN();  ///< NaN without one [s]
  double track_time = 0, hand_time = 0, world_time = 0;              ///< [s]
};

/// One plan update.
struct PlanSnapshot {
  std::int64_t id = 0;
  std::int64_t step = 0;  ///< of the world, whose target was planned
  bool planned = false;
  TargetFrame target;
  Plan plan;
  PlayedPlan played;                                      ///< what the emission makes of it
  std::shared_ptr<const PipelineSettings> settings;       ///< that it was planned with
  double full_scale_pressure = 0.0;                       ///< rendered, at intensity 1 [Pa]
  double emission_rate = 0.0;                             ///< samples of the emission [Hz]
  std::optional<GateResult> gate;                         ///< of the target
  double contact_time = 0, plan_time = 0, lift_time = 0;  ///< [s]
  double latency =
      std::numeric_limits<double>::quiet_NaN();  ///< of the last one that was emitted [s]
};

/// Counters, and what holds between steps, a few dozen times a second.
struct RunSnapshot {
  double time = 0.0;                         ///< run time [s]
  double world_rate = 0.0, plan_rate = 0.0;  ///< over the last second [Hz]
  bool paused = false, fading = false;
  PageHandReport page_hand;
  Advice advice;       ///< while the rates are not held
  DeviceStats device;  ///< since the start of the run, as are the next
  EmitStats emit;
  double full_scale_pressure = 0.0;  ///< [Pa]
  double intensity = 0.0;            ///< of the strongest focal point now, 0..1

  bool page_hand_in_charge() const { return page_hand.state == PageHandState::Held; }
};

/// The hand-off. Each function says whose it is.
class Snapshots {
 public:
  // ---- the world's thread ----
  /// A step has met its hands.
  void step(const WorldFrame& frame, const WorldStage& stage);
  /// The world has settled: the density in its box, while somebody looks.
  void volume(const World& world);

  // ---- the planner's thread ----
  /// Publishes an update. @param latency of the last plan that was emitted, NaN without one [s].
  void plan(const WorldFrame& contact, const PlanFrame& plan, double latency);

  // ---- the thread that called run() ----
  /// Settings that plans are made with from now on, with the widths of the array's focus where
  /// `array_width` asks for them. @pre the planner's thread does not run.
  void use(std::shared_ptr<const PipelineSettings> settings) { settings_ = std::move(settings); }
  RunSnapshot& run_draft() { return run_.draft(); }
  void publish_run() { run_.publish(); }
  bool watched() const { return watched_.load(std::memory_order_relaxed); }

  // ---- the onlooker's thread ----
  void watch(bool somebody) { watched_.store(somebody, std::memory_order_relaxed); }
  bool refresh_step() { return step_.refresh(); }
  const StepSnapshot& step() const { return step_.value(); }
  bool refresh_volume() { return volume_.refresh(); }
  const VolumeView& volume() const { return volume_.value(); }
  bool refresh_plan() { return plan_.refresh(); }
  const PlanSnapshot& plan() const { return plan_.value(); }
  bool refresh_run() { return run_.refresh(); }
  const RunSnapshot& run() const { return run_.value(); }
  /// Reads the oldest latency that was not read yet; false without one.
  bool next_latency(double& out) { return latencies_.pop(out); }

 private:
  std::atomic<bool> watched_{false};
  Latest<StepSnapshot> step_;
  Latest<VolumeView> volume_;
  Latest<PlanSnapshot> plan_;
  Latest<RunSnapshot> run_;
  SpscRing<double> latencies_{256};  // when full the newest are lost: nobody looks
  std::shared_ptr<const PipelineSettings> settings_;
};

/// The field that a plan renders on its target as it is played, by Eq. (1) with the plan's own
/// width.
struct RenderedPlan {
  std::array<std::vector<double>, kMaxPatches> field;  ///< of each patch, unit of the target
  Metrics metrics;                                     ///< of the patch with the most pressure
  int patch = 0;                                       ///< that one
  double sigma = 0.0;                                  ///< that they are at [m]
  Metrics metrics_at_setting;                          ///< the same at [plan] sigma
  double max_target = 0.0;                             ///< over all patches [Pa]
  /// total forces of the target, of the smoke and of the hands' own movement [N]; NaN where the two
  /// are not known apart
  double force = 0.0, smoke_force = 0.0, movement_force = 0.0;
};

/// For the onlooker's thread: this takes about as long as a plan.
void render(const PlanSnapshot& plan, RenderedPlan& out);

}  // namespace prostm
