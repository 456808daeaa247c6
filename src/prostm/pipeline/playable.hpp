#pragma once
/// The limits of what is played, checked where settings are given.

#include "prostm/device/device.hpp"
#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// Checks that an emission for this device plays the settings as they are: no later stage clamps a
/// speed, a time or a level. The table in docs/design/emission.md lists all limits.
/// @throws std::invalid_argument with a sentence that names the setting, its value and the limit.
void require_playable(const PipelineSettings& settings, const DeviceInfo& device);

}  // namespace prostm
