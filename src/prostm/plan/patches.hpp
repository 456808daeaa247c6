#pragma once
/// What every planner asks of the patches of a frame before it plans, and how they share what
/// there is.

#include <array>
#include <cstddef>

#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// Largest pressure on skin, or −1 when the target cannot be planned: PlanStatus::InvalidTarget
/// says which those are. @param max_cells the largest raster that there is room for.
double highest_pressure(const TargetField& target, std::size_t max_cells);

using PatchPressures = std::array<double, kMaxPatches>;

/// Shares out `count` focal points one by one: first one to each patch that has pressure, the
/// strongest first, then to the patch with the highest pressure per focal point if it got one more
/// (d'Hondt's rule).
std::array<int, kMaxPatches> share_out(const PatchPressures& pressure, int count);

}  // namespace prostm::planning
