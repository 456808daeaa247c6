#pragma once
/// The threads of a run: what they share, and what each has for itself. Private to pipeline.

#include <atomic>
#include <cstdint>
#include <semaphore>

#include "prostm/core/latest.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/pipeline/detail/run_end.hpp"
#include "prostm/pipeline/detail/run_log.hpp"
#include "prostm/pipeline/snapshot.hpp"

namespace prostm {

/// How a run is paced; constant.
struct RunPace {
  RunPace(const PipelineSettings& settings, const RunOptions& options);
  const bool realtime, prepare_early, stay;
  const double dt;  // of a step [s]
  const std::int64_t steps;
  const double frame_wait;  // [s]
};

/// One plan update as the observer sees it.
struct Update {
  WorldFrame contact;
  PlanFrame plan;
};

struct RunShared {
  RunEnd end;
  // constant while the threads run
  double start = 0.0;              // what the clock shows at run time 0 [s]
  bool endless = false;            // the run's seconds are over, and it goes on
  Snapshots* snapshots = nullptr;  // of a run that can be looked at

  std::atomic<bool> halt{false};  // asks the threads to end, to be started again
  std::atomic<bool> world_ended{false}, plan_ended{false};
  std::atomic<double> run_time{0.0};             // [s]
  std::atomic<double> planned_at{0.0};           // when the last plan was [s of the clock]
  std::atomic<std::int64_t> planned_step{0};     // of the last plan that was handed over
  std::atomic<std::int64_t> steps{0}, plans{0};  // steps and plan updates so far
  Latest<WorldFrame> newest;                     // real time
  std::counting_semaphore<> ready{0};            // a target is there, or none will come
  SpscRing<WorldFrame> targets{4};               // as fast as possible
  SpscRing<Update> updates{64};
};

/// Hand, world and skin, with a clock or without.
class WorldSide {
 public:
  WorldSide(Pipeline& pipeline, const RunPace& pace, RunShared& shared)
      : pipeline_(pipeline), pace_(pace), shared_(shared) {}

  /// On a thread of its own, until the run or the segment ends. What fails ends the run.
  void run() noexcept;

  // ---- while no thread runs ----
  /// Counts a step that the caller has made.
  void count(const WorldFrame& frame);
  /// Steps as fast as they go until one has made a target, which is published.
  void run_to_target();
  /// Sets the clock so that run time goes on from where it was.
  void set_clock();
  /// Whether the run's seconds are over, or were before.
  bool done() const { return slot_ >= pace_.steps; }
  double time() const { return static_cast<double>(slot_) * pace_.dt; }  ///< run time [s]
  std::int64_t published() const { return published_; }
  const WorldLog& log() const { return log_; }

 private:
  void in_real_time();
  void without_clock();
  bool goes_on() const;
  bool meet(double due, WorldFrame& frame);
  void settled(double time);
  void take_hands(double due, double wait, WorldFrame& frame);
  void wait_for_plan(std::int64_t step, double latest) const;
  double run_time() const;

  Pipeline& pipeline_;
  const RunPace& pace_;
  RunShared& shared_;
  std::int64_t slot_ = 0;       // of the step before
  std::int64_t published_ = 0;  // targets
  WorldLog log_;
};

/// Plans and their emission. Without a clock it makes the device play, too.
class PlanSide {
 public:
  PlanSide(Pipeline& pipeline, const RunPace& pace, RunShared& shared)
      : pipeline_(pipeline), pace_(pace), shared_(shared), log_(pace.realtime) {}

  /// On a thread of its own, until the world's has ended. What fails ends the run.
  void run() noexcept;

  // ---- while no thread runs ----
  /// Counts an update that the caller has made.
  void count(const WorldFrame& contact, const PlanFrame& frame);
  /// Plans the newest target if one was published.
  void plan_newest();
  /// Takes in what became of the plans.
  void follow() { log_.follow(pipeline_.plans().emitter(), pipeline_.device()); }
  std::int64_t unobserved() const { return unobserved_; }
  const PlanLog& log() const { return log_; }

 private:
  void in_real_time();
  void without_clock();
  void plan(const WorldFrame& contact);

  Pipeline& pipeline_;
  const RunPace& pace_;
  RunShared& shared_;
  PlanFrame spare_;
  std::int64_t unobserved_ = 0;
  PlanLog log_;
};

}  // namespace prostm
