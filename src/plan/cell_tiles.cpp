#include "plan/cell_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
  for (std::vector<double>& sums : columns_) sums.resize(max_cells);
}

/// Sums rows [begin, end) into columns_.
void CellTiles::add_rows(const TargetField& target, int begin, int end) {
  const auto cols = static_cast<std::size_t>(target.cols);
  std::array<std::span<double>, 3> sums;
  for (std::size_t q = 0; q < 3; ++q) {
    sums[q] = {columns_[q].data(), cols};
    std::fill(sums[q].begin(), sums[q].end(), 0.0);
  }
  for (int row = begin; row < end; ++row) {
    const std::size_t first = target.index(row, 0);
    add_row({target.pressure.data() + first, cols}, {target.skin.data() + first, cols}, row,
            {sums[0], sums[1], sums[2]});
  }
}

/// The block over `factor` columns of columns_.
CellTiles::Block CellTiles::sum_columns(const TargetField& target, std::size_t block, int factor) {
  Block sum{};
  const auto width = static_cast<std::size_t>(factor);
  const std::size_t begin = block * width;
  const std::size_t end = std::min(begin + width, static_cast<std::size_t>(target.cols));
  for (std::size_t col = begin; col < end; ++col) {
    sum.pressure += columns_[0][col];
    sum.col += columns_[1][col] * static_cast<double>(col);
    sum.row += columns_[2][col];
    sum.count += columns_[1][col];
  }
  return sum;
}

void CellTiles::set(const TargetField& target, double maximum, double width) {
  const double cell = kMmPerMetre * target.cell;
  int factor = std::max(1, static_cast<int>(std::floor(width / cell + 1e-6)));
  while (blocks(target.rows, factor) * blocks(target.cols, factor) > kMaxBlocks) ++factor;
  const std::size_t cols = blocks(target.cols, factor), rows = blocks(target.rows, factor);

  // average the blocks
  for (int row = 0; row < target.rows; row += factor) {
    add_rows(target, row, std::min(row + factor, target.rows));
    Block* const block = &blocks_[static_cast<std::size_t>(row / factor) * cols];
    for (std::size_t c = 0; c < cols; ++c) block[c] = sum_columns(target, c, factor);
  }

  // gather the tiles that have skin
  tiles_.clear();
  peak_ = 0.0F;
  square_ = 0.0;
  const auto unit = static_cast<float>(cell * cell) / kUnitArea;
  for (std::size_t row = 0; row < rows; row += kTileRows) {
    for (std::size_t col = 0; col < cols; col += kTileCols) {
      CellTile tile{};
      bool skin = false;
      for (std::size_t k = 0; k < 8; ++k) {
        const std::size_t r = row + k / kTileCols, c = col + k % kTileCols;
        if (r >= rows || c >= cols || blocks_[r * cols + c].count == 0.0) continue;
        const Block& block = blocks_[r * cols + c];
        const double each = 1.0 / block.count;
        tile.x[k] = static_cast<float>(cell * each * block.col);
        tile.y[k] = static_cast<float>(cell * each * block.row);
        tile.pressure[k] = static_cast<float>(block.pressure * each / maximum);
        tile.weight[k] = static_cast<float>(block.count) * unit;
        peak_ = std::max(peak_, tile.pressure[k]);
        square_ += static_cast<double>(tile.weight[k] * tile.pressure[k] * tile.pressure[k]);
        skin = true;
      }
      if (!skin) continue;
      enclose(tile);
      tiles_.push_back(tile);
    }
  }
}

}  // namespace prostm::planning
