#pragma once
/// The paper's Eq. (1), (P10) of docs/design/planner.md: the quasi-static pressure field of a plan;
/// (B2) for foci.

#include <span>

#include "prostm/plan/quasi_static/quasi_static_pressure.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Computes p(x) = p_i/γ · exp(−‖x − x_i‖² / 2σ²), where x_i is the closest point to x over all
/// segments of all paths of `patch`, γ is that of its path, and p_i is linear between the samples
/// of its segment. Writes to `out` (rows·cols of `raster`) for every cell, skin or not; all zeros
/// if the patch has no path. Ties go to the lower path and segment index. For foci x_i is the
/// nearest focus and γ = 1.
/// @param sigma fall-off of a focal point [m], > 0.  @param gain γ of each path.  @param instead
/// pressures of the whole plan that replace its own.  @pre out.size() == raster.size().
void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        const GainLaw& gain, std::span<double> out,
                        const SegmentPressures* instead = nullptr);

}  // namespace prostm
