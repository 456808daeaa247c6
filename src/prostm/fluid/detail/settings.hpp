#pragma once
/// Bounds of the fluid's settings.

#include "prostm/fluid/fluid.hpp"

namespace prostm::fluid {

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
void validate(const FluidSettings& settings);
void validate(const SmokeInflow& inflow);

}  // namespace prostm::fluid
