#pragma once
/// Which way the skin of a raster faces.

#include "prostm/target/target_field.hpp"

namespace prostm {

/// The unit normal in P of the skin at a cell, out of the skin, towards the array's side (z < 0):
/// that of the plane of least squares through the heights of the skin within two cells, since the
/// stairs of a raster have no slope of their own. −z where there is no skin, or no slope to tell.
/// Allocates nothing. @pre the cell is in the raster, heights are finite.
Vec3 skin_normal(const TargetField& field, int row, int col);

}  // namespace prostm
