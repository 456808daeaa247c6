#pragma once
/// Divergence through partly open faces, and subtraction of the pressure gradient.

#include "prostm/fluid/detail/obstacle.hpp"
#include "prostm/fluid/detail/padded_grid.hpp"
#include "prostm/fluid/detail/pressure/pressure_level.hpp"

namespace prostm::fluid {

/// Sums over one plane of cells, so that totals do not depend on threads.
struct DivergenceSum {
  double squares = 0.0;  ///< Σ (flux out of a cell over h²)², open cells [m²/s²]
  float largest = 0.0F;  ///< [m/s]
};

/// Computes the net outflow of each cell of plane k over h² [m/s]: Σ ±(a u + (1 − a) u_wall) (F5),
/// 0 in closed cells. Writes it times `scale` to `out` unless that is null.
DivergenceSum divergence(const PressureLevel& level, const Obstacle& obstacle,
                         const Field velocity[3], int k, float scale, float* out);

/// u −= factor·(p_above − p_below) on the faces that plane k owns: x and y, and z below it; the
/// last plane owns those above it too (F7). On the open sides p = 0 half a cell away. The floor
/// keeps its jets; shut faces take the wall's velocity.
void subtract_gradient(const PressureLevel& level, const Obstacle& obstacle, const float* p,
                       float factor, Field velocity[3], int k);

}  // namespace prostm::fluid
