#pragma once
/// A small tile of weighted points on skin.

#include <array>
#include <vector>

namespace prostm::planning {

/// Eight neighbouring cells, 4 × 2. Cells without skin, or whose skin has weight 0, have weight 0.
/// All positions in mm from the centre of the target's cell (0, 0).
struct alignas(32) CellTile {
  float x[8], y[8];
  float pressure[8];  ///< p* over the frame's maximum
  float weight[8];    ///< skin area in the cell over kUnitArea, times the mean weight (P17)
  float centre_x, centre_y, radius;
};

/// Mean weight (P17) of each cell of each tile; empty if the target has no weights (all 1).
using MeanWeights = std::vector<std::array<float, 8>>;

inline constexpr float kUnitArea = 4.0F;  ///< area counted as 1 in the reconstruction error [mm²]

}  // namespace prostm::planning
