#pragma once
/// The counters of a run's threads. Private to pipeline.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "prostm/pipeline/latency.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm {

/// Counters of the world's stage; used only by its thread until that has ended.
class WorldLog {
 public:
  /// Records a step that has just met the hands.
  void meet(const WorldFrame& frame);
  /// Records that the world has settled after the step.
  void settle(const WorldStage& stage);
  /// Records skipped steps.
  void skip(std::int64_t steps) { skipped_ += steps; }

  std::int64_t steps() const { return steps_; }
  void write(RunSummary& out) const;

 private:
  std::int64_t steps_ = 0, skipped_ = 0, resets_ = 0;
  ContactStats contact_stats_;
  std::span<const WorldQuantity> quantities_;            // quantities of the newest world
  std::array<double, kMaxWorldQuantities> values_ = {};  // sums over the steps of the newest world
  std::int64_t before_ = 0;                              // steps of earlier worlds
  Distribution track_, hand_, world_, contact_;
};

/// Counters of the plan stage, including the latency of plans to the device; used only by its
/// thread until that has ended.
class PlanLog {
 public:
  explicit PlanLog(bool realtime) : latency_(realtime) {}

  /// @param run_start device's clock at run time 0 [s].
  void add(const WorldFrame& contact, const PlanFrame& frame, double run_start);
  /// Reads the emitter's new reports.
  void follow(Emitter& emitter, const Device& device);

  const LatencyLog& latency() const { return latency_; }
  void write(RunSummary& out) const;

 private:
  void judge(double time, const GateResult& gate);

  std::int64_t plans_ = 0, empty_ = 0, long_paths_ = 0, crossings_ = 0, judged_ = 0, passed_ = 0;
  std::optional<double> held_since_;  // run time [s]
  std::int64_t held_ = 0, held_passed_ = 0;
  std::array<std::int64_t, kNames<GateProblem>.size()> held_problems_{};
  double max_path_length_ = 0.0, max_skin_length_ = 0.0;
  Distribution plan_, lift_, lap_, focus_speed_;
  LatencyLog latency_;
};

}  // namespace prostm
