#pragma once
/// How a plan is felt, and whether a plan with fewer paths is felt better.

#include <string>

#include "prostm/pipeline/settings.hpp"
#include "prostm/score/plan_percept.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Returns the percept of a plan as the array of the settings plays it.
PlanPercept percept_of(const TargetField& target, const Plan& plan,
                       const PipelineSettings& settings);

/// Plans with fewer paths, and returns advice if one of these plans is felt better in shape and in
/// strength than a plan with `paths` paths; else empty. Takes about 0.3 s for each number.
std::string fewer_paths_advice(const TargetField& target, const PipelineSettings& settings,
                               int paths, const Metrics& played);

}  // namespace prostm::app
