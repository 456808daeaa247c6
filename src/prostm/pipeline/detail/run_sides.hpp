#pragma once
/// The threads of a run: their shared and their own state. Private to pipeline.

#include <atomic>
#include <cstdint>
#include <semaphore>

#include "prostm/core/latest.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/pipeline/detail/run_end.hpp"
#include "prostm/pipeline/detail/run_log.hpp"
#include "prostm/pipeline/snapshot.hpp"

namespace prostm {

/// Timing of a run; constant.
struct RunPace {
  RunPace(const PipelineSettings& settings, const RunOptions& options);
  const bool realtime, prepare_early, stay;
  const double dt;  // time step [s]
  const std::int64_t steps;
  const double frame_wait;  // [s]
};

/// One plan update, passed to the observer.
struct Update {
  WorldFrame contact;
  PlanFrame plan;
};

struct RunShared {
  RunEnd end;
  // constant while the threads run
  double start = 0.0;              // clock at run time 0 [s]
  bool endless = false;            // the run continues after its seconds are over
  Snapshots* snapshots = nullptr;  // null unless the run has viewers

  std::atomic<bool> halt{false};  // asks the threads to end; they will be restarted
  std::atomic<bool> world_ended{false}, plan_ended{false};
  std::atomic<double> run_time{0.0};             // [s]
  std::atomic<double> planned_at{0.0};           // time of the last plan [s of the clock]
  std::atomic<std::int64_t> planned_step{0};     // step of the last submitted plan
  std::atomic<std::int64_t> steps{0}, plans{0};  // steps and plan updates so far
  Latest<WorldFrame> newest;                     // used in real time
  std::counting_semaphore<> ready{0};            // signals a new target, or that none will come
  SpscRing<WorldFrame> targets{4};               // used without a clock
  SpscRing<Update> updates{64};
};

/// The stages of hand, world and skin, in real time or without a clock.
class WorldSide {
 public:
  WorldSide(Pipeline& pipeline, const RunPace& pace, RunShared& shared)
      : pipeline_(pipeline), pace_(pace), shared_(shared) {}

  /// Thread function: runs until the run or the segment ends. A failure ends the run.
  void run() noexcept;

  // ---- while no thread runs ----
  /// Counts a step made by the caller.
  void count(const WorldFrame& frame);
  /// Runs steps without a clock until one makes a target, and publishes it.
  void run_to_target();
  /// Sets the clock so that run time continues from its last value.
  void set_clock();
  /// Whether the run's seconds are over.
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
  std::int64_t slot_ = 0;       // of the previous step
  std::int64_t published_ = 0;  // number of targets
  WorldLog log_;
};

/// The stages of planning and emission. Without a clock it also makes the device play.
class PlanSide {
 public:
  PlanSide(Pipeline& pipeline, const RunPace& pace, RunShared& shared)
      : pipeline_(pipeline), pace_(pace), shared_(shared), log_(pace.realtime) {}

  /// Thread function: runs until the world's thread has ended. A failure ends the run.
  void run() noexcept;

  // ---- while no thread runs ----
  /// Counts an update made by the caller.
  void count(const WorldFrame& contact, const PlanFrame& frame);
  /// Plans the newest target if one was published.
  void plan_newest();
  /// Reads the emitter's reports on the plans.
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
