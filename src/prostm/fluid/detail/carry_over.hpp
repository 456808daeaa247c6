#pragma once
/// Shifts the fields of a box that moves.

#include "prostm/core/geometry.hpp"
#include "prostm/fluid/detail/padded_grid.hpp"

namespace prostm::fluid {

/// new(c) = old(c + by), or the nearest old value where the box was not before. The halo is kept.
/// @param axis of a field of faces, which has one value more along it; 3: a field of cells.
void carry_over(const PaddedGrid& grid, const CellShift& by, int axis, Field& field);

}  // namespace prostm::fluid
