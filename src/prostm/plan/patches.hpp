#pragma once
/// Checks of a frame's patches before planning, and the sharing out of focal points among them.

#include <array>
#include <cstddef>

#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// Returns the largest pressure on skin, or −1 if the target cannot be planned, as
/// PlanStatus::InvalidTarget lists. @param max_cells the largest raster that there is room for.
double highest_pressure(const TargetField& target, std::size_t max_cells);

using PatchPressures = std::array<double, kMaxPatches>;

/// Shares out `count` focal points one by one: first one to each patch that has pressure, the
/// strongest first, then each to the patch that would have the highest pressure per focal point
/// with one more (d'Hondt's rule).
std::array<int, kMaxPatches> share_out(const PatchPressures& pressure, int count);

}  // namespace prostm::planning
