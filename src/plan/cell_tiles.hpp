#pragma once
/// The skin of a target as weighted points in small tiles: what a plan is fitted to.

#include <array>
#include <cstddef>
#include <vector>

#include "target/target_field.hpp"

namespace prostm::planning {

/// Eight neighbouring cells, 4 × 2. Cells without skin have weight 0. All lengths in mm from the
/// centre of the target's cell (0, 0).
struct alignas(32) CellTile {
  float x[8], y[8];
  float pressure[8];  ///< p* over the frame's maximum
  float weight[8];    ///< skin area in the cell over kUnitArea
  float centre_x, centre_y, radius;
};

inline constexpr float kUnitArea = 4.0F;  ///< [mm²] that counts as 1 in the reconstruction error

/// The target on a raster of its own or of a coarser resolution: blocks of factor × factor cells
/// are averaged over their skin.
class CellTiles {
 public:
  static constexpr std::size_t kMaxTiles = 8192;

  /// @param max_cells the largest target that set() will be given.
  explicit CellTiles(std::size_t max_cells);

  /// Takes over the skin cells of `target`, averaged so that a block is no wider than `width` [mm]
  /// where the target's cells allow it, and wider where that would be more than kMaxBlocks.
  /// Allocates nothing. @pre maximum > 0, sizes agree, the target has no more than max_cells.
  void set(const TargetField& target, double maximum, double width);

  const std::vector<CellTile>& tiles() const { return tiles_; }
  float peak() const { return peak_; }            ///< highest pressure of a block
  double square_norm() const { return square_; }  ///< Σ weight · pressure²

 private:
  struct Block {
    double pressure;         // sums over its skin cells: in the target's unit,
    double col, row, count;  // indices, and how many cells there are
  };
  void add_rows(const TargetField& target, int begin, int end);
  Block sum_columns(const TargetField& target, std::size_t block, int factor);

  std::vector<CellTile> tiles_;
  std::vector<Block> blocks_;
  std::array<std::vector<double>, 3> columns_;  // of a row of blocks: pressure, cells, row indices
  float peak_ = 0.0F;
  double square_ = 0.0;
};

}  // namespace prostm::planning
