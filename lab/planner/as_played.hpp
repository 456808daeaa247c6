#pragma once
/// The quality of what is played of a plan, which is what the tables state.

#include "prostm/emit/played.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm::bench {

/// By the emission's defaults, at a full scale of γ times the target's largest pressure.
inline SegmentPressures played(const TargetField& target, const Plan& plan,
                               const PlanSettings& settings) {
  if (plan.empty()) return {};
  EmitSettings emit;
  emit.full_scale_pressure = own_full_scale(settings.gain, max_pressure(target));
  return played_pressures(plan, target, emit, 40e3);
}

/// score_plan() of that, with the planner's σ and γ.
inline Metrics score_as_played(const TargetField& target, const Plan& plan,
                               const PlanSettings& settings) {
  const SegmentPressures pressures = played(target, plan, settings);
  return score_plan(target, plan, 0, settings.sigma, settings.gain_law(), &pressures);
}

}  // namespace prostm::bench
