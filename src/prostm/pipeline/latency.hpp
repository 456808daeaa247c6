#pragma once
/// Where the time goes from a tracker's frame to the first sample planned from it.

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

/// The parts of a latency in the order of time, (L3): each follows the one before without a gap.
enum LatencyPart : int {
  kFrameWait,  ///< the tracker's frame is there, the step that takes it is not due yet
  kLateStart,  ///< the step is due, and has not taken the hands
  kHandPart,   ///< the hands are filtered and drawn on the grid
  kWorldPart,  ///< the world meets the hands
  kContactPart,
  kHandOver,  ///< until the planner's thread begins
  kPlanPart,
  kLiftPart,   ///< onto the skin, and to the emitter
  kBlockWait,  ///< until the device asks for a block; below 0 where it is asked late
  kLapWait,    ///< until the first focal point goes over
  kQueuePart,  ///< of the device
  kLatencyParts
};

const char* latency_part_name(int part);  ///< "frame", "late", "hand", …, as in run summaries

/// The latency of one plan [s]. The parts add up to the total.
struct Latency {
  std::array<double, kLatencyParts> part{};
  double total = 0.0;
};

/// Follows plans from the tracker to the device. Allocates nothing after construction.
class LatencyLog {
 public:
  /// @param realtime whether the stages' own times count: without a clock a plan is made in no
  /// time, at the run time that its hands were taken.
  explicit LatencyLog(bool realtime) : realtime_(realtime) {}

  /// A plan was handed to the emitter. @param run_start what the device's clock shows at run time 0
  /// [s].
  void plan(const WorldFrame& contact, const PlanFrame& plan, double run_start) noexcept;
  /// The emitter reports on a plan.
  void follow(const TakeOver& event, const Device& device) noexcept;

  /// The latency of the plan that was followed last; empty before the first.
  const std::optional<Latency>& last() const { return last_; }
  /// Its total, NaN before the first [s].
  double last_total() const {
    return last_ ? last_->total : std::numeric_limits<double>::quiet_NaN();
  }
  Summary total() const { return total_.summary(); }
  Summary redraw() const { return redraw_.summary(); }  ///< until 90 % of the plan were drawn [s]
  Summary part(int part) const { return parts_[static_cast<std::size_t>(part)].summary(); }

 private:
  struct Plan {
    double arrival = 0.0, submitted = 0.0;  // on the device's clock [s]
    Latency latency;                        // parts up to submitted
  };

  const bool realtime_;
  std::array<Plan, 256> plans_{};  // by id; one is taken over within a few updates or never
  std::optional<Latency> last_;
  Distribution total_, redraw_;
  std::array<Distribution, kLatencyParts> parts_;
};

}  // namespace prostm
