#pragma once
/// Checks whether plans follow their targets: steadily when a target moves, at once when a contact
/// appears.

#include <vector>

#include "planner/contenders.hpp"
#include "prostm/plan/plan.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Returns how far a plan's paths are from those of the previous plan [m]. Paths are paired so that
/// the sum of their distances is least. The distance of two paths is the mean over 40 equal arcs,
/// for the start point and direction that make it least: a plan moved rigidly by d has moved by d.
/// A path without a partner has moved by its mean distance to the other plan. The result is the
/// mean over the paths of the plan with more; 0 if both are empty. @pre neither is empty alone.
double motion(const Plan& before, const Plan& after);

/// Prints two tables: the mean motion relative to the displacement of fields that move rigidly,
/// with the RMSE beside it because a frozen plan would be steadiest; and the number of updates
/// until half of the pressure of a new contact is rendered.
void measure_steadiness(std::vector<Contender>& contenders, std::vector<Row>& rows);

}  // namespace prostm::bench
