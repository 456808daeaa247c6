#pragma once
/// Makes frames of the wire from the snapshots of a run. Private to viewer.

#include <chrono>
#include <deque>

#include "prostm/pipeline/live.hpp"
#include "prostm/viewer/detail/felt_watch.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm::viewer {

/// Values of a recent time span, and their quantiles.
class Recent {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Recent(double seconds) : span_(seconds) {}
  void add(Clock::time_point now, double value);
  /// Discards values older than the span.
  void trim(Clock::time_point now);
  /// Smallest value that a share p of the values do not exceed; NaN without values.
  double quantile(double p);

 private:
  struct Entry {
    Clock::time_point at;
    double value;
  };
  const double span_;  // [s]
  std::deque<Entry> entries_;
  std::vector<double> sorted_;
};

/// Makes frames, and keeps the state needed between them.
class FrameMaker {
 public:
  FrameMaker(Snapshots& snapshots, const Mute& mute) : snapshots_(snapshots), mute_(mute) {}
  /// Fills in the frame, except for its sequence number, from new snapshots. A paused run is shown
  /// at one instant: hands, smoke and plan are updated together.
  void refresh(ViewFrame& frame, ViewNews& news);

 private:
  void take(ViewFrame& frame, ViewNews& news);
  void take_plan(ViewFrame& frame);
  void fill_scores(ViewFrame& frame) const;
  void fill_latencies(ViewFrame& frame);
  void fill_numbers(ViewFrame& frame);
  std::uint32_t flags(const ViewFrame& frame) const;

  Snapshots& snapshots_;
  const Mute& mute_;
  bool new_step_ = true, new_smoke_ = false,
       new_plan_ = false;  // new data that are not in a frame yet
  RenderedPlan rendered_;
  Recent latencies_{10.0};
  FeltWatch felt_;
};

}  // namespace prostm::viewer
