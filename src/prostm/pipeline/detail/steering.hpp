#pragma once
/// Does between two steps what onlookers ask of a run, and tells them how it stands. Private to
/// pipeline; the thread that runs it.

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
  /// Lets a run go on that is paused.
  void play();
  /// Does everything that is asked. @pre no other thread uses the pipeline.
  void attend();
  /// Whether one more plan update is asked of a run that is paused.
  bool next_update();

  Snapshots& snapshots() { return link_.snapshots; }
  /// Publishes the counters, a few dozen times a second at most. @param time run time [s].
  /// @param steps, plans of the fluid, and plan updates, so far. @param fading no plan came for a
  /// while.  @param advice while the rates are not held.
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
  double shown_ = 0.0, told_ = 0.0;  // when last [s of the clock]
  RecentRate step_rate_, plan_rate_;
};

}  // namespace prostm
