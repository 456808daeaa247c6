#include "plan/cell_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/pressure_raster.hpp"

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
}

void CellTiles::set(const TargetField& target, double maximum, double width) {
  const double cell = kMmPerMetre * target.cell;
  int factor = std::max(1, static_cast<int>(std::floor(width / cell + 1e-6)));
  while (blocks(target.rows, factor) * blocks(target.cols, factor) > kMaxBlocks) ++factor;
  const std::size_t cols = blocks(target.cols, factor), rows = blocks(target.rows, factor);

  // average the blocks
  std::fill_n(blocks_.begin(), rows * cols, Block{});
  for (int row = 0; row < target.rows; ++row) {
    const std::size_t block_row = static_cast<std::size_t>(row / factor) * cols;
    std::size_t i = target.index(row, 0);
    int within = 0;
    std::size_t block = block_row;
    for (int col = 0; col < target.cols; ++col, ++i) {
      if (target.skin[i] != 0) {
        Block& sum = blocks_[block];
        sum.pressure += target.pressure[i];
        sum.col += static_cast<float>(col);
        sum.row += static_cast<float>(row);
        sum.count += 1.0F;
      }
      if (++within == factor) {
        within = 0;
        ++block;
      }
    }
  }

  // gather the tiles that have skin
  tiles_.clear();
  peak_ = 0.0F;
  square_ = 0.0;
  const auto unit = static_cast<float>(cell * cell) / kUnitArea;
  const auto width_of_cell = static_cast<float>(cell);
  for (std::size_t row = 0; row < rows; row += kTileRows) {
    for (std::size_t col = 0; col < cols; col += kTileCols) {
      CellTile tile{};
      bool skin = false;
      for (std::size_t k = 0; k < 8; ++k) {
        const std::size_t r = row + k / kTileCols, c = col + k % kTileCols;
        if (r >= rows || c >= cols || blocks_[r * cols + c].count == 0.0F) continue;
        const Block& block = blocks_[r * cols + c];
        tile.x[k] = width_of_cell * block.col / block.count;
        tile.y[k] = width_of_cell * block.row / block.count;
        tile.pressure[k] =
            static_cast<float>(block.pressure / static_cast<double>(block.count) / maximum);
        tile.weight[k] = block.count * unit;
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
