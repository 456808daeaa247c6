#pragma once
/// Latency from a tracker's frame to the first sample planned from it, by parts.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "prostm/core/distribution.hpp"
#include "prostm/device/device.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm {

/// The parts of a latency in order of time, (L3), without gaps between them.
enum LatencyPart : int {
  kFrameWait,  ///< from the tracker's frame until the step that takes it is due
  kLateStart,  ///< until the step takes the hands
  kHandPart,   ///< filtering and rasterising the hands
  kWorldPart,  ///< computing the world with the hands
  kContactPart,
  kHandOver,  ///< until the planner's thread starts
  kPlanPart,
  kLiftPart,   ///< lifting onto the skin, and submission to the emitter
  kBlockWait,  ///< until the device requests a block; negative if the request is late
  kLapWait,    ///< until the first focal point switches to the plan
  kQueuePart,  ///< queue of the device
  kLatencyParts
};

const char* latency_part_name(int part);  ///< "frame", "late", "hand", …, as in run summaries

/// The latency of one plan [s]. The parts add up to the total.
struct Latency {
  std::array<double, kLatencyParts> part{};
  double total = 0.0;
};

/// Measures the latency of plans from the tracker to the device. Does not allocate after
/// construction.
class LatencyLog {
 public:
  /// @param realtime whether to include the stages' times: without a clock, a plan takes no time,
  /// at the run time at which its hands were taken.
  explicit LatencyLog(bool realtime) : realtime_(realtime) {}

  /// Records a plan submitted to the emitter. @param run_start device's clock at run time 0 [s].
  void plan(const WorldFrame& contact, const PlanFrame& plan, double run_start) noexcept;
  /// Records the emitter's report on a plan.
  void follow(const TakeOver& event, const Device& device) noexcept;

  /// The latency of the last completed plan; empty before the first.
  const std::optional<Latency>& last() const { return last_; }
  /// Total of last() [s]; NaN before the first.
  double last_total() const {
    return last_ ? last_->total : std::numeric_limits<double>::quiet_NaN();
  }
  Summary total() const { return total_.summary(); }
  Summary redraw() const {
    return redraw_.summary();
  }  ///< time until 90 % of the plan is drawn [s]
  Summary part(int part) const { return parts_[static_cast<std::size_t>(part)].summary(); }

 private:
  struct Plan {
    double arrival = 0.0, submitted = 0.0;  // on the device's clock [s]
    Latency latency;                        // parts up to submitted
  };

  const bool realtime_;
  std::array<Plan, 256> plans_{};  // by id; a plan takes over within a few updates or never
  std::optional<Latency> last_;
  Distribution total_, redraw_;
  std::array<Distribution, kLatencyParts> parts_;
};

}  // namespace prostm
