#pragma once
/// Builds the level-finding procedures that protocols describe.

#include <cstdint>
#include <variant>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/staircase.hpp"

namespace prostm {

/// The procedure that chooses the next level of a track.
using Procedure = std::variant<WeightedUpDown, BayesianStaircase, Adjustment>;

/// The staircase that [level] asks for: up-down, or bayes. @param guess the guess rate: share of
/// answers for the level when guessing, 0..1. @throws std::invalid_argument: a setting that is
/// invalid for the staircase.
Procedure staircase_of(const LevelSettings& level, double guess);

/// The successive adjustments of a track. @param repeats number of adjustments.
/// @throws std::invalid_argument as staircase_of() does.
Procedure adjustments_of(const LevelSettings& level, int repeats, std::uint64_t seed);

}  // namespace prostm
