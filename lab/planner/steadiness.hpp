#pragma once
/// Whether plans follow what they show: steadily where it moves, at once where something appears.

#include <vector>

#include "planner/contenders.hpp"
#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// How far the paths of a plan are from those of the one before [m]. Paths are paired so that the
/// sum of their distances is least; the distance of two paths is the mean over 40 equal arcs, for
/// the start point and direction that make it least, so that a plan that is moved rigidly by d has
/// moved by d. A path without a partner has moved by its mean distance to the other plan. The mean
/// over the paths of the plan with more; 0 when both are empty, @pre neither is empty alone.
double motion(const Plan& before, const Plan& after);

/// Prints both tables: mean motion against the displacement of fields that move rigidly, with the
/// RMSE beside it because a frozen plan would be steadiest; and how many updates a contact that
/// appears takes until half of its pressure is rendered.
void measure_steadiness(std::vector<Contender>& contenders, std::vector<Row>& rows);

}  // namespace prostm::bench
