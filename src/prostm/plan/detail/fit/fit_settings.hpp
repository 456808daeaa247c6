#pragma once
/// Settings of the search and of its cost, by the planner's settings.

#include "prostm/plan/detail/fit/search.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::planning {

/// Settings of the cost that fitted presets minimise.
FitSettings fit_settings(const PlanSettings& settings);
/// Limits of their search.
SearchSettings search_settings(const PlanSettings& settings);
/// Number of pieces into which a plan divides each segment of the search. The pressure is linear
/// between samples, so it follows the field better the closer they lie.
int pieces_of(const PlanSettings& settings);

}  // namespace prostm::planning
