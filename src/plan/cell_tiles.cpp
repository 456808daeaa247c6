#include "plan/cell_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "plan/pressure_raster.hpp"
#include "plan/raster_rows.hpp"

namespace prostm::planning {
namespace {

constexpr int kTileCols = 4, kTileRows = 2;
constexpr std::size_t kMaxBlocks = 2 * CellTiles::kMaxTiles;  // a tile spans two rows at least

std::size_t blocks(int cells, int factor) {
  return static_cast<std::size_t>((cells + factor - 1) / factor);
}

/// Sets the circle about the cells that have weight; the others move to its centre.
void enclose(CellTile& tile) {
  float low_x = std::numeric_limits<float>::max(), low_y = low_x;
  float high_x = std::numeric_limits<float>::lowest(), high_y = high_x;
  for (std::size_t k = 0; k < 8; ++k) {
    if (tile.weight[k] == 0.0F) continue;
    low_x = std::min(low_x, tile.x[k]);
    high_x = std::max(high_x, tile.x[k]);
    low_y = std::min(low_y, tile.y[k]);
    high_y = std::max(high_y, tile.y[k]);
  }
  tile.centre_x = 0.5F * (low_x + high_x);
  tile.centre_y = 0.5F * (low_y + high_y);
  tile.radius = std::hypot(high_x - tile.centre_x, high_y - tile.centre_y);
  for (std::size_t k = 0; k < 8; ++k) {
    if (tile.weight[k] != 0.0F) continue;
    tile.x[k] = tile.centre_x;
    tile.y[k] = tile.centre_y;
  }
}

}  // namespace

CellTiles::CellTiles(std::size_t max_cells) {
  const std::size_t most = std::min(max_cells, kMaxBlocks);
  blocks_.resize(most);
  tiles_.reserve(std::min(most, kMaxTiles));
  mean_weight_.reserve(tiles_.capacity());
  for (std::size_t q = 0; q < 3; ++q) columns_[q].resize(max_cells);
  columns_[3].reserve(max_cells);
}

/// Sums rows [begin, end) into columns_. @param weights of the cells, or null: 1.
void CellTiles::add_rows(const TargetField& target, const CellWeights* weights, int begin,
                         int end) {
  const auto cols = static_cast<std::size_t>(target.cols);
  if (weights != nullptr) columns_[3].resize(cols);
  for (std::vector<double>& sums : columns_) {
    std::fill_n(sums.begin(), std::min(sums.size(), cols), 0.0);
  }
  const std::span<double> pressure(columns_[0].data(), cols), weight(columns_[1].data(), cols),
      rows(columns_[2].data(), cols);
  for (int row = begin; row < end; ++row) {
    const std::size_t first = target.index(row, 0);
    if (weights == nullptr) {
      add_row({target.pressure.data() + first, cols}, {target.skin.data() + first, cols}, row,
              {pressure, weight, rows});
      continue;
    }
    for (std::size_t c = 0; c < cols; ++c) {
      if (target.skin[first + c] == 0) continue;
      const double w = (*weights)[first + c];
      pressure[c] += w * target.pressure[first + c];
      weight[c] += w;
      rows[c] += w * row;
      columns_[3][c] += 1.0;
    }
  }
}

/// The block over `factor` columns of columns_.
CellTiles::Block CellTiles::sum_columns(const TargetField& target, std::size_t block,
                                        int factor) const {
  Block sum{};
  const auto width = static_cast<std::size_t>(factor);
  const std::size_t begin = block * width;
  const std::size_t end = std::min(begin + width, static_cast<std::size_t>(target.cols));
  for (std::size_t col = begin; col < end; ++col) {
    sum.pressure += columns_[0][col];
    sum.col += columns_[1][col] * static_cast<double>(col);
    sum.row += columns_[2][col];
    sum.weight += columns_[1][col];
    if (!target.weight.empty()) sum.count += columns_[3][col];
  }
  return sum;
}

void CellTiles::set(const TargetField& target, double maximum, double width) {
  const double cell = kMmPerMetre * target.cell;
  int factor = std::max(1, static_cast<int>(std::floor(width / cell + 1e-6)));
  while (blocks(target.rows, factor) * blocks(target.cols, factor) > kMaxBlocks) ++factor;
  const std::size_t cols = blocks(target.cols, factor), rows = blocks(target.rows, factor);

  // average the blocks
  const bool has_weights = !target.weight.empty();
  std::optional<CellWeights> weights;
  if (has_weights) weights.emplace(target, maximum);
  for (int row = 0; row < target.rows; row += factor) {
    add_rows(target, has_weights ? &*weights : nullptr, row, std::min(row + factor, target.rows));
    Block* const block = &blocks_[static_cast<std::size_t>(row / factor) * cols];
    for (std::size_t c = 0; c < cols; ++c) block[c] = sum_columns(target, c, factor);
  }
  gather(rows, cols, cell, maximum, has_weights);
}

/// Fills tiles_ with the blocks whose skin counts. @param cell edge of the target's cells [mm].
void CellTiles::gather(std::size_t rows, std::size_t cols, double cell, double maximum,
                       bool has_weights) {
  tiles_.clear();
  mean_weight_.clear();
  peak_ = 0.0F;
  square_ = 0.0;
  const auto unit = static_cast<float>(cell * cell) / kUnitArea;
  for (std::size_t row = 0; row < rows; row += kTileRows) {
    for (std::size_t col = 0; col < cols; col += kTileCols) {
      CellTile tile{};
      std::array<float, 8> mean_weight{};
      bool skin = false;
      for (std::size_t k = 0; k < 8; ++k) {
        const std::size_t r = row + k / kTileCols, c = col + k % kTileCols;
        if (r >= rows || c >= cols || blocks_[r * cols + c].weight == 0.0) continue;
        const Block& block = blocks_[r * cols + c];
        const double each = 1.0 / block.weight;
        tile.x[k] = static_cast<float>(cell * each * block.col);
        tile.y[k] = static_cast<float>(cell * each * block.row);
        tile.pressure[k] = static_cast<float>(block.pressure * each / maximum);
        tile.weight[k] = static_cast<float>(block.weight) * unit;
        mean_weight[k] = has_weights ? static_cast<float>(block.weight / block.count) : 1.0F;
        peak_ = std::max(peak_, mean_weight[k] * tile.pressure[k]);
        square_ += static_cast<double>(tile.weight[k] * tile.pressure[k] * tile.pressure[k]);
        skin = true;
      }
      if (!skin) continue;
      enclose(tile);
      tiles_.push_back(tile);
      if (has_weights) mean_weight_.push_back(mean_weight);
    }
  }
}

}  // namespace prostm::planning
