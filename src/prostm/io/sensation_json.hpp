#pragma once
/// Sensation levels as JSON.

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/acoustics/skin/sensation_level.hpp"

namespace prostm {

/// The level and its interval [dB], and the source of the sound pressure; null for NaN.
inline nlohmann::ordered_json sensation_to_json(double level, const SensationInterval& interval) {
  if (std::isnan(level)) return nullptr;
  return {{"level_db", level},
          {"interval_db", {level - interval.below, level + interval.above}},
          {"sound", name_of(interval.sound)}};
}

}  // namespace prostm
