#pragma once
/// More pressure where the skin does not face the array.

#include "prostm/plan/lifted_plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// What the radiation pressure of a focal point is to be multiplied by on skin with the outward
/// normal n at p [m], both in D, so that what presses on the skin is the same as if it faced the
/// array's middle, (E8): min(bound, 1/cos²β), β between n and the way to the middle. `bound` where
/// it faces away. @pre bound >= 1, p is not the origin.
double tilt_factor(const Vec3& p_D, const Vec3& normal_D, double bound);

/// Multiplies the pressure of each focus, and of each point of each path, by the tilt_factor of the
/// skin there; with a bound of 1 nothing changes. Allocates nothing.
/// @param frame that the plan was lifted with. @pre bound >= 1.
void compensate_tilt(LiftedPlan& plan, const TargetFrame& frame, double bound) noexcept;

}  // namespace prostm
