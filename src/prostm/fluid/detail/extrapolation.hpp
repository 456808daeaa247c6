#pragma once
/// The fluid's velocity carried a little way into the hands.

#include <cstdint>

#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure_level.hpp"

namespace prostm::fluid {

/// Gives shut faces of `axis` the mean of the neighbouring faces that the fluid passes, two layers
/// deep; deeper ones keep the wall's velocity. Advection then finds the fluid's tangential velocity
/// behind a wall, which makes the wall slip.
/// @param layer one byte per face, all 0 before and after.
void extend_into_hands(const PressureLevel& level, int axis, Field& u,
                       PaddedField<std::uint8_t>& layer);

}  // namespace prostm::fluid
