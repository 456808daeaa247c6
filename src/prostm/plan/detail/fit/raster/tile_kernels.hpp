#pragma once
/// Kernels on tiles of eight cells.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/plan/detail/fit/raster/cell_tile.hpp"

namespace prostm::planning {

/// Sums over the rows of one row of blocks, column by column, padded with zeros to the end of the
/// last tile.
struct BlockRow {
  const double *pressure, *weight, *row;  ///< weighted sums: p*, weights, row indices
  const double* count;                    ///< number of cells; null if the target has no weights
  std::size_t factor;                     ///< columns per block
  double cell;                            ///< edge of a column [mm]
  double maximum;                         ///< p* that becomes 1
};

/// Fills upper (half 0) or lower (half 1) halves of a row of tiles, and of their mean weights.
void fill_tiles(const BlockRow& blocks, std::size_t half, std::span<CellTile> tiles,
                std::span<std::array<float, 8>> mean_weight);

struct TileSums {
  float peak = 0.0F;         ///< highest mean weight · pressure of a cell
  double square_norm = 0.0;  ///< Σ weight · pressure²
};

/// Removes the tiles in which no cell has weight. For every other tile, computes the circle around
/// its cells with weight, and moves its other cells to the circle's centre.
TileSums complete_tiles(std::vector<CellTile>& tiles, MeanWeights& mean_weight);

/// Positions and weighted pressures of cells, with room for eight more past the end.
struct CellList {
  float *x, *y, *pressure;
};

/// Writes the cells of a tile that have weight and a weighted pressure of at least `threshold`, in
/// order. @param mean_weight mean weight of each cell; null: all 1. @param allowed bit set of the
/// cells that may be written. @return the number of cells written.
std::size_t list_strong_cells(const CellTile& tile, const float* mean_weight, float threshold,
                              unsigned allowed, const CellList& list);

}  // namespace prostm::planning
