#pragma once
/// Pressures of AM's foci at given positions.

#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Sets each focus's pressure by (B3), p_i = Σ p* φ / Σ φ² over the skin cells that are nearest to
/// it (ties go to the first focus), the least-squares solution of the model (B2). A focus without
/// such a cell within 5 σ is removed: by the model it would need e^12.5 times p*. Allocates
/// nothing.
/// @param sigma fall-off of a focal point [m], > 0.  @pre p* is finite, not negative and at most
/// 1e300.
void set_pressures(const TargetField& target, double sigma, FocalPoints& foci);

}  // namespace prostm
