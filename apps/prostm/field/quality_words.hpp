#pragma once
/// The quality of a rendering in four numbers, with the same names in all commands.

#include <cstdio>
#include <string>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Returns how strongly a stimulus is felt, and whether that is nominal. @param level not NaN.
std::string level_words(double level, const SensationInterval& interval);

/// Prints shape by Eq. (1), felt shape, felt strength and spill, one line each. What was not
/// computed has the reason `unfelt` instead; without a reason its line is left out.
/// @param lowest, highest if not null, the range of the numbers, whose medians `metrics` are.
void print_quality_numbers(std::FILE* out, const Metrics& metrics,
                           const SensationInterval& interval, const std::string& unfelt = {},
                           const Metrics* lowest = nullptr, const Metrics* highest = nullptr);

}  // namespace prostm::app
