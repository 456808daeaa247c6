#pragma once
/// The loop that all focal points of a plan in step share, in samples.

#include "prostm/emit/detail/focus_motion.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm {

/// Returns the loop of a plan, (E10), before the laps of any path are known: `base` is loop · rate,
/// rounded up, and `samples` the smallest multiple of it that leaves time for a lap of the longest
/// path. For a plan without a loop, all are 0.
/// @param sample_rate [Hz]; @param max_step largest step between samples [m]. @pre
/// is_loop(plan.loop); the paths are measured, with finite numbers.
InStep shared_loop(const LiftedPlan& plan, double sample_rate, double max_step);

/// Returns `loop` with the laps of a path in it: as many as follow from its speed, at least one,
/// and no more than the largest step allows; 0 for a path that is a point or shorter than one step,
/// and without a loop.
InStep with_laps(InStep loop, const LiftedPath& path, double sample_rate, double max_step);

/// Returns the place on a path that corresponds to its loop's clock. @pre the loop has samples; the
/// path has a point and is measured.
PathPlace place_in_step(const LiftedPath& path, const InStep& in_step);

}  // namespace prostm
