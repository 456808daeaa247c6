#pragma once
/// Raises the pressure where the skin does not face the array.

#include "prostm/plan/lifted_plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Returns the factor on the radiation pressure of a focal point, for skin with the outward normal
/// n at p [m], both in D, so that the skin is pressed as if it faced the array's middle, (E8):
/// min(bound, 1/cos²β), with β between n and the direction to the middle. `bound` if it faces away.
/// @pre bound >= 1, p is not the origin.
double tilt_factor(const Vec3& p_D, const Vec3& normal_D, double bound);

/// Multiplies the pressure of each focus, and of each point of each path, by the tilt_factor of the
/// skin there; with a bound of 1 nothing changes. Allocates nothing.
/// @param frame frame that the plan was lifted with. @pre bound >= 1.
void compensate_tilt(LiftedPlan& plan, const TargetFrame& frame, double bound) noexcept;

}  // namespace prostm
