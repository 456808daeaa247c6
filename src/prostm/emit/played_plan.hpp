#pragma once
/// The emission of a plan: speeds and periods as played.

#include <boost/container/static_vector.hpp>
#include <string>
#include <vector>

#include "prostm/emit/emitter.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm {

/// A path as PathEmitter plays it. All zero for a path without points.
struct PlayedPath {
  double planned_speed = 0.0;   ///< of the plan [m/s]
  double planned_period = 0.0;  ///< of a lap on the skin at that speed [s]; 0: at rest
  double speed = 0.0;           ///< mean over a lap on the skin [m/s]; 0: at rest
  double period = 0.0;          ///< of a lap [s]; 0: at rest
  int laps = 0;                 ///< in the loop of a plan in step, otherwise 1; 0: at rest

  /// Whether the period differs from the plan's by more than a sample and the margin of steps.
  bool changed(double sample_rate) const;
};

struct PlayedPlan {
  boost::container::static_vector<PlayedPath, kMaxPaths> paths;  ///< in the order of LiftedPlan
  double loop = 0.0;         ///< in which all paths come round together [s]; 0: each on its own
  double sample_rate = 0.0;  ///< of the emission [Hz]
  double max_speed = 0.0;    ///< speed limit of focal points [m/s]

  int changed_paths() const;  ///< paths whose period differs from the plan's
};

/// Computes how PathEmitter plays the paths of a plan, from the same lap counts, (E2) and (E10).
/// Allocates nothing. Foci are played as planned: `paths` is empty for them.
/// @param plan its paths are measured, with finite numbers. @param sample_rate of the emission
/// [Hz].
/// @param max_speed limit of the emitter [m/s]. @pre is_loop(plan.loop).
PlayedPlan played_plan(const LiftedPlan& plan, double sample_rate,
                       double max_speed = kMaxFocusSpeed) noexcept;

/// Sets speeds, periods and the loop of a plan to those that are played. Paths at rest stay as they
/// are. @param played of the same plan, lifted.
void take_played(const PlayedPlan& played, Plan& plan) noexcept;

/// Returns one sentence for each path whose period differs from the plan's, with its cause.
std::vector<std::string> played_warnings(const PlayedPlan& played);

}  // namespace prostm
