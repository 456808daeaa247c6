#pragma once
/// The loop that all focal points of a plan in step share, in samples.

#include "prostm/emit/detail/focus_motion.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm {

/// Returns the loop of a plan, (E10), before the laps of any path are known: `base` is round(loop ·
/// rate), and `samples` the fewest such loops that leave time for a lap of the longest path. A plan
/// without a loop has none.
/// @param sample_rate [Hz]; @param max_step largest step between samples [m]. @pre
/// is_loop(plan.loop); the paths are measured, with finite numbers.
InStep shared_loop(const LiftedPlan& plan, double sample_rate, double max_step);

/// Sets the laps of a path in its plan's loop: as many as its speed says, at least one, and no more
/// than the largest step allows; 0 for a path that is a point or shorter than one step. Does
/// nothing without a loop.
InStep with_laps(InStep loop, const LiftedPath& path, double sample_rate, double max_step);

/// Returns the place of a path where the clock of its loop is. @pre the loop has samples; the path
/// has a point and is measured.
PathPlace place_in_step(const LiftedPath& path, const InStep& in_step);

}  // namespace prostm
