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

constexpr std::size_t kTileCols = 4, kTileRows = 2;
constexpr std::size_t kMaxBlocks = 2 * CellTiles::kMaxTiles;  // a tile spans two rows at least

template <typename N>
std::size_t ceil_div(N n, N divisor) {
  return static_cast<std::size_t>((n + divisor - 1) / divisor);
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
  const float dx = high_x - tile.centre_x, dy = high_y - tile.centre_y;
  tile.radius = std::sqrt(dx * dx + dy * dy);
  for (std::size_t k = 0; k < 8; ++k) {
    if (tile.weight[k] != 0.0F) continue;
    tile.x[k] = tile.centre_x;
    tile.y[k] = tile.centre_y;
  }
}

}  // namespace

CellTiles::CellTiles(std::size_t max_cells) {
  tiles_.reserve(std::min(max_cells, kMaxTiles));
  mean_weight_.reserve(tiles_.capacity());
  for (std::vector<double>& sums : columns_) sums.reserve(max_cells);
}

/// Sums rows [begin, end) into columns_. @param weights of the cells, or null: 1.
void CellTiles::add_rows(const TargetField& target, const CellWeights* weights, int begin,
                         int end) {
  const auto cols = static_cast<std::size_t>(target.cols);
  for (std::vector<double>& sums : columns_) sums.assign(cols, 0.0);
  const std::span<double> pressure = columns_[0], weight = columns_[1], rows = columns_[2];
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

/// Fills the tiles with row `row` of the blocks. @param cell edge of the target's cells [mm].
void CellTiles::fill_row(const TargetField& target, std::size_t row, int factor, double cell,
                         double maximum) {
  const auto unit = static_cast<float>(cell * cell) / kUnitArea;
  const std::size_t cols = ceil_div(target.cols, factor),
                    first = row / kTileRows * ceil_div(cols, kTileCols);
  for (std::size_t c = 0; c < cols; ++c) {
    const Block block = sum_columns(target, c, factor);
    if (block.weight == 0.0) continue;
    const std::size_t t = first + c / kTileCols, k = row % kTileRows * kTileCols + c % kTileCols;
    const double each = 1.0 / block.weight;
    CellTile& tile = tiles_[t];
    tile.x[k] = static_cast<float>(cell * each * block.col);
    tile.y[k] = static_cast<float>(cell * each * block.row);
    tile.pressure[k] = static_cast<float>(block.pressure * each / maximum);
    tile.weight[k] = static_cast<float>(block.weight) * unit;
    if (!mean_weight_.empty()) mean_weight_[t][k] = static_cast<float>(block.weight / block.count);
  }
}

/// Leaves out the tiles without skin that counts, and completes the others.
void CellTiles::complete() {
  peak_ = 0.0F;
  square_ = 0.0;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tiles_.size(); ++t) {
    CellTile& tile = tiles_[t];
    if (std::all_of(tile.weight, tile.weight + 8, [](float w) { return w == 0.0F; })) continue;
    enclose(tile);
    for (std::size_t k = 0; k < 8; ++k) {
      peak_ = std::max(peak_, mean_weight(t, k) * tile.pressure[k]);
      square_ += static_cast<double>(tile.weight[k] * tile.pressure[k] * tile.pressure[k]);
    }
    tiles_[kept] = tile;
    if (!mean_weight_.empty()) mean_weight_[kept] = mean_weight_[t];
    ++kept;
  }
  tiles_.resize(kept);
  if (!mean_weight_.empty()) mean_weight_.resize(kept);
}

void CellTiles::set(const TargetField& target, double maximum, double width) {
  const double cell = kMmPerMetre * target.cell;
  int factor = std::max(1, static_cast<int>(std::floor(width / cell + 1e-6)));
  while (ceil_div(target.rows, factor) * ceil_div(target.cols, factor) > kMaxBlocks) ++factor;
  const std::size_t rows = ceil_div(target.rows, factor), cols = ceil_div(target.cols, factor);
  const std::size_t tiles = ceil_div(rows, kTileRows) * ceil_div(cols, kTileCols);
  tiles_.assign(tiles, CellTile{});
  mean_weight_.clear();
  std::optional<CellWeights> weights;
  if (!target.weight.empty()) {
    weights.emplace(target, maximum);
    mean_weight_.resize(tiles);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const int begin = static_cast<int>(row) * factor;
    add_rows(target, weights ? &*weights : nullptr, begin, std::min(begin + factor, target.rows));
    fill_row(target, row, factor, cell, maximum);
  }
  complete();
}

}  // namespace prostm::planning
