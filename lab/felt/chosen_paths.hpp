#pragma once
/// Plans whose number of paths is chosen by felt shape and strength.

#include <string>

#include "felt/ways.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::bench {

/// Plans with every number of paths up to that of `settings`, and keeps the plan with the least
/// lack − weight · ln strength by the planner's model: the lack (W3), and the strongest √e on the
/// nominal skin over the output (P20) that the plan demands. @pre felt_weight is above 0.
/// @param weight lack that is worth a strength 2.7 times as high.
Way chosen_paths(const std::string& name, const PlanSettings& settings, double weight,
                 const TransducerArray& array);

}  // namespace prostm::bench
