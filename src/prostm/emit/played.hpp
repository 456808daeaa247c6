#pragma once
/// The pressures of a plan as they are played.

#include "prostm/emit/emitter.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Returns the full scale of a plan on its own, outside a session: γ times the target's largest
/// pressure, within the bounds of validate().
double own_full_scale(double gain, double largest);

/// Returns the pressures that PathEmitter plays once a plan is in its steady state, (E9): after the
/// drive law, full scale, the slew limit and the power limit. They are those of the second lap,
/// each path begun at its first point, or the mean of laps if the power limit makes them differ.
/// The factor of (E8) is divided out again, so that only pressure beyond full scale is missing. For
/// a plan of foci, they are the peak of each, (B4). A lap of more than a second counts as a second.
/// A plan in step is played loop by loop.
/// @param frame frame that the plan was made for. @param settings all paths or foci of the plan are
/// played, whatever `foci` says. @throws as validate(settings, sample_rate) and require_loop() do.
/// @pre every patch of the plan is in the frame.
SegmentPressures played_pressures(const Plan& plan, const TargetFrame& frame, EmitSettings settings,
                                  double sample_rate);
/// The same for a plan for one field.
SegmentPressures played_pressures(const Plan& plan, const TargetField& field, EmitSettings settings,
                                  double sample_rate);

}  // namespace prostm
