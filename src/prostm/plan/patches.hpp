#pragma once
/// Checks of a frame's patches before planning, and the allocation of focal points to them.

#include <array>
#include <cstddef>

#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// Returns the largest pressure on skin, or −1 if the target is invalid, see
/// PlanStatus::InvalidTarget. @param max_cells capacity of the planner, in cells.
double highest_pressure(const TargetField& target, std::size_t max_cells);

using PatchPressures = std::array<double, kMaxPatches>;

/// Allocates `count` focal points: first one to each patch that has pressure, the strongest first,
/// then each to the patch that would have the highest pressure per focal point with one more
/// (d'Hondt's rule).
std::array<int, kMaxPatches> share_out(const PatchPressures& pressure, int count);

}  // namespace prostm::planning
