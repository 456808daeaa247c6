#pragma once
/// What a plan's pressures become when they are played.

#include "prostm/emit/emitter.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/plan/quasi_static.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// The full scale of a plan that stands for itself, without a session's: γ times the target's
/// largest pressure, within what validate() takes.
double own_full_scale(double gain, double largest);

/// The pressures that PathEmitter plays once a plan goes round, (E9): the drive law, full scale,
/// the limit on how fast an intensity changes and the power limit have done what they do. They are
/// those of the second lap, each path begun at its first point; where the power limit makes laps
/// differ, their mean. What (E8) multiplied is divided again, so that what it asks for beyond full
/// scale is missing and nothing else is changed. Of a plan of foci each one's peak, (B4).
/// A lap of more than a second counts as one of a second.
/// @param frame that the plan was made for. @param settings as many paths or foci as the plan has
/// are played. @throws as validate(settings, sample_rate) does. @pre every patch of the plan is one
/// of the frame's.
SegmentPressures played_pressures(const Plan& plan, const TargetFrame& frame, EmitSettings settings,
                                  double sample_rate);
/// The same of a plan for one field.
SegmentPressures played_pressures(const Plan& plan, const TargetField& field, EmitSettings settings,
                                  double sample_rate);

}  // namespace prostm
