#pragma once
/// Matching of focal points to the paths of a new plan.

#include <array>

#include "prostm/plan/plan.hpp"

namespace prostm {

inline constexpr int kNoPath = -1;

/// cost[focus][path], and cost[focus][kMaxPaths] for a focal point that gets no path.
using MatchCosts = std::array<std::array<double, kMaxPaths + 1>, kMaxPaths>;

/// Returns the assignment of least total cost in which every path has a focal point, (E5): exact,
/// by dynamic programming over sets of paths; ties go to the lower index. @pre 0 <= paths <= foci
/// <= kMaxPaths.
/// @return for each focal point its path, or kNoPath.
std::array<int, kMaxPaths> match_paths(const MatchCosts& cost, int foci, int paths) noexcept;

}  // namespace prostm
