#pragma once
/// Interface of the planners of one patch.

#include "prostm/plan/plan.hpp"
#include "prostm/plan/plan_stats.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// One patch of a frame, and what a plan for it may use.
struct PatchTask {
  const TargetField& target;
  double maximum = 0.0;     ///< its largest pressure, > 0
  double full_scale = 0.0;  ///< rendered pressure at full output, > 0 [unit of the target]
  int patch = 0;            ///< its index in the frame
  int paths = 0;            ///< maximum number of paths
  double budget = 0.0;      ///< time limit [s]; 0: only the counts of the settings apply
  /// Whether no other patch has paths in this plan: with several patches, all use the same loop.
  bool is_alone = true;
  double time = 0.0;  ///< time of the frame [s]
};

/// Plans the paths of one patch, frame by frame.
class PatchPlanner {
 public:
  virtual ~PatchPlanner() = default;
  /// Forgets the last plan.
  virtual void reset() = 0;
  /// Appends paths to `plan` and adds to `stats` (all but the total). Allocates and throws nothing.
  virtual void plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) = 0;
};

}  // namespace prostm::planning
