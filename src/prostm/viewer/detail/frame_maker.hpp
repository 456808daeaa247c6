#pragma once
/// From the snapshots of a run to the frames of the wire. Private to viewer.

#include <chrono>
#include <deque>

#include "prostm/pipeline/live.hpp"
#include "prostm/viewer/detail/felt_watch.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm::viewer {

/// Values of the last while, and what they say of it.
class Recent {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Recent(double seconds) : span_(seconds) {}
  void add(Clock::time_point now, double value);
  /// Forgets what is older than the span.
  void trim(Clock::time_point now);
  /// The share p of the values are not above this; NaN without any.
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

/// Keeps what it needs from frame to frame.
class FrameMaker {
 public:
  FrameMaker(Snapshots& snapshots, const Mute& mute) : snapshots_(snapshots), mute_(mute) {}
  /// Takes what is new and fills in the frame, but for its sequence number. A run that is paused is
  /// shown at one instant: hands, smoke and plan wait for each other.
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
  bool new_step_ = true, new_smoke_ = false, new_plan_ = false;  // and not in a frame yet
  RenderedPlan rendered_;
  Recent latencies_{10.0};
  FeltWatch felt_;
};

}  // namespace prostm::viewer
