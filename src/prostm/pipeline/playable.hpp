#pragma once
/// Limits of the emission, checked when settings are given.

#include "prostm/device/device.hpp"
#include "prostm/pipeline/settings.hpp"

namespace prostm {

/// Checks that this device can play the settings unchanged: no later stage clamps a speed, a time
/// or a level. The table in docs/design/emission.md lists all limits.
/// @throws std::invalid_argument with a sentence that names the setting, its value and the limit.
void require_playable(const PipelineSettings& settings, const DeviceInfo& device);

}  // namespace prostm
