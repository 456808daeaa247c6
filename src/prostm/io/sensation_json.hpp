#pragma once
/// Sensation levels as JSON.

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/acoustics/skin/sensation_level.hpp"

namespace prostm {

/// The level and its interval [dB], and which amplitude of the array they are for; null for NaN.
inline nlohmann::ordered_json sensation_to_json(double level, const TransducerArray& array) {
  if (std::isnan(level)) return nullptr;
  const SensationInterval interval = sensation_interval(array);
  return {{"level_db", level},
          {"interval_db", {level - interval.below, level + interval.above}},
          {"amplitude", array.measured_amplitude > 0.0 ? "measured" : "nominal"}};
}

}  // namespace prostm
