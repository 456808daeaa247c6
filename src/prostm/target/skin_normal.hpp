#pragma once
/// Normals of the skin on a raster.

#include "prostm/target/target_field.hpp"

namespace prostm {

/// Returns the unit normal in P of the skin at a cell, pointing out of the skin towards the array's
/// side (z < 0). It is the normal of the least-squares plane through the heights of the skin within
/// two cells, since the steps of a raster do not show the slope. Returns −z if there is no skin or
/// the slope is undetermined. Allocates nothing. @pre the cell is in the raster, heights are
/// finite.
Vec3 skin_normal(const TargetField& field, int row, int col);

}  // namespace prostm
