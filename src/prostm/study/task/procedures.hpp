#pragma once
/// The procedures that search for a level, as protocols describe them.

#include <cstdint>
#include <variant>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/staircase.hpp"

namespace prostm {

/// The search for the next level of a track.
using Procedure = std::variant<WeightedUpDown, BayesianStaircase, Adjustment>;

/// The staircase that [level] asks for: up-down, or bayes. @param guess share of answers for the
/// level that guessing makes, 0..1. @throws std::invalid_argument: a setting that the staircase
/// does not take.
Procedure staircase_of(const LevelSettings& level, double guess);

/// Adjustments, one after the other, in a track. @param repeats how many.
/// @throws std::invalid_argument as staircase_of() does.
Procedure adjustments_of(const LevelSettings& level, int repeats, std::uint64_t seed);

}  // namespace prostm
