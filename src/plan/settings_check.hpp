#pragma once
/// The bounds of the planner's settings.

#include "plan/planner.hpp"

namespace prostm::planning {

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bounds.
void check_settings(const PlanSettings& settings);

}  // namespace prostm::planning
