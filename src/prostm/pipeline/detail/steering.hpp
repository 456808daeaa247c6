#pragma once
/// Executes viewers' commands between two steps of a run, and publishes its state. Private to
/// pipeline; used by the thread that runs it.

#include <string>
#include <vector>

#include "prostm/pipeline/detail/recent_rate.hpp"
#include "prostm/pipeline/live.hpp"

namespace prostm {

class Steering {
 public:
  Steering(LiveLink& link, Pipeline& pipeline);

  bool pending() { return link_.control.pending(); }
  bool playing() const { return state_.playing; }
  /// Resumes a paused run.
  void play();
  /// Executes all pending commands. @pre no other thread uses the pipeline.
  void attend();
  /// Whether a paused run is asked for one more plan update.
  bool next_update();

  Snapshots& snapshots() { return link_.snapshots; }
  /// Publishes the counters, a few dozen times per second at most. @param time run time [s].
  /// @param steps, plans number of steps and plan updates so far. @param fading whether the output
  /// fades for lack of a plan. @param advice current advice, None while the rates are held.
  void show(double time, std::int64_t steps, std::int64_t plans, bool fading, const Advice& advice);

 private:
  void apply(const LiveSettings& wanted, const std::vector<std::uint32_t>& senders);
  void change(const LiveSettings& wanted);
  void publish_state();
  double intensity() const;

  LiveLink& link_;
  Pipeline& pipeline_;
  LiveState state_;
  std::shared_ptr<const PipelineSettings> planned_with_;
  int updates_asked_ = 0;
  double shown_ = 0.0, told_ = 0.0;  // times of the last call [s of the clock]
  RecentRate step_rate_, plan_rate_;
};

}  // namespace prostm
