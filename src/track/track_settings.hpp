#pragma once
/// Validation of the settings of hand sources. Private to track.

#include "track/hand_source.hpp"

namespace prostm {

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bounds.
void validate(const TrackSettings& settings);
void validate(const ScriptedHandSettings& settings);

}  // namespace prostm
