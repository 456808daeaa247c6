#pragma once
/// The skin of a target as weighted points in small tiles, the data that plans are fitted to.

#include <array>
#include <cstddef>
#include <vector>

#include "prostm/plan/detail/fit/raster/cell_tile.hpp"
#include "prostm/plan/detail/fit/raster/cell_weights.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// The target at its own or a coarser resolution: blocks of factor × factor cells are averaged over
/// their skin, with the target's weights if it has any.
class CellTiles {
 public:
  static constexpr std::size_t kMaxTiles = 8192;

  /// @param max_cells largest number of cells of a target passed to set().
  explicit CellTiles(std::size_t max_cells);

  /// Averages the skin cells of `target` into blocks. Blocks are at most `width` [mm] wide, unless
  /// the target's cells are wider or the number of blocks would exceed the capacity. Allocates
  /// nothing. @pre maximum > 0, sizes agree, the target has at most max_cells cells and, if it has
  /// weights, one > 0 on skin.
  void set(const TargetField& target, double maximum, double width);

  const std::vector<CellTile>& tiles() const { return tiles_; }
  /// Mean weights (P17) of the skin in the cells of tile t, 0 without weighted skin; null if the
  /// target has no weights.
  const float* mean_weights(std::size_t t) const {
    return mean_weight_.empty() ? nullptr : mean_weight_[t].data();
  }
  /// Mean weight of the skin in cell c of tile t.
  float mean_weight(std::size_t t, std::size_t c) const {
    return mean_weight_.empty() ? 1.0F : mean_weight_[t][c];
  }
  float peak() const { return peak_; }            ///< highest mean weight · pressure of a block
  double square_norm() const { return square_; }  ///< Σ weight · pressure²

 private:
  void sum_rows(const TargetField& target, const CellWeights* weights, int begin, int end);

  std::vector<CellTile> tiles_;
  MeanWeights mean_weight_;
  // sums over a row of blocks: pressure, weights, row indices and, for a target with weights, the
  // number of cells
  std::array<std::vector<double>, 4> columns_;
  float peak_ = 0.0F;
  double square_ = 0.0;
};

}  // namespace prostm::planning
