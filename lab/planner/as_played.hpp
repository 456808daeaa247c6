#pragma once
/// Quality of a plan as it is played; the tables state this quality.

#include "prostm/emit/played.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm::bench {

/// Returns the pressures played with the emission's default settings, with full scale at γ times
/// the target's largest pressure.
inline SegmentPressures played(const TargetField& target, const Plan& plan,
                               const PlanSettings& settings) {
  if (plan.empty()) return {};
  EmitSettings emit;
  emit.full_scale_pressure = own_full_scale(settings.gain, max_pressure(target));
  return played_pressures(plan, target, emit, 40e3);
}

/// Scores the plan as it is played, with the planner's σ and γ.
inline Metrics score_as_played(const TargetField& target, const Plan& plan,
                               const PlanSettings& settings) {
  const SegmentPressures pressures = played(target, plan, settings);
  return score_plan(target, plan, 0, settings.sigma, settings.gain_law(), &pressures);
}

}  // namespace prostm::bench
