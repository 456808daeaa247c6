#pragma once
/// The quality of a rendering in four numbers, with the same names in all commands.

#include <cstdio>
#include <string>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Why a percept may not be computed: the limits of is_felt().
inline constexpr const char* kPerceptLimits =
    "not computed for loops of more than 250 ms, rasters of more than 128 cells along an edge, or "
    "cells of more than 20 mm";

/// Returns how strongly a stimulus is felt, and whether that is nominal. @param level not NaN.
std::string level_words(double level, const SensationInterval& interval);

/// Returns the four numbers in one line; those that are not known are omitted.
std::string quality_line(const Metrics& metrics, const SensationInterval& interval);

/// Prints shape by Eq. (1), felt shape, felt strength and spill, one line each.
/// @param unfelt why there is no percept, if so. @param lowest, highest if not null, the
/// range of the numbers, whose medians `metrics` are.
void print_quality_numbers(std::FILE* out, const Metrics& metrics,
                           const SensationInterval& interval, const std::string& unfelt,
                           const Metrics* lowest = nullptr, const Metrics* highest = nullptr);

}  // namespace prostm::app
