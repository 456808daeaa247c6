#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "prostm/plan/detail/fit/raster/tile_kernels.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"
#include "prostm/plan/detail/raster_rows.hpp"

namespace prostm::planning {
namespace {

constexpr std::size_t kTileCols = 4, kTileRows = 2;
constexpr std::size_t kMaxBlocks = 2 * CellTiles::kMaxTiles;  // a tile spans two rows of blocks

template <typename N>
std::size_t ceil_div(N n, N divisor) {
  return static_cast<std::size_t>((n + divisor - 1) / divisor);
}

}  // namespace

CellTiles::CellTiles(std::size_t max_cells) {
  tiles_.reserve(std::min(max_cells, kMaxTiles));
  mean_weight_.reserve(tiles_.capacity());
  // up to five times the columns or rows, since the last tile is padded
  for (std::vector<double>& sums : columns_) sums.reserve(5 * max_cells);
}

/// Sums rows [begin, end) into columns_. @param weights of the cells; null: all 1.
void CellTiles::sum_rows(const TargetField& target, const CellWeights* weights, int begin,
                         int end) {
  const auto cols = static_cast<std::size_t>(target.cols);
  const auto column = [&](std::size_t k) { return std::span(columns_[k]).first(cols); };
  const std::span<double> pressure = column(0), weight = column(1), rows = column(2);
  if (weights == nullptr) {
    planning::sum_rows(target.pressure, target.skin, begin, end, {pressure, weight, rows});
    return;
  }
  for (std::size_t k = 0; k < 4; ++k) std::ranges::fill(column(k), 0.0);
  for (int row = begin; row < end; ++row) {
    const std::size_t first = target.index(row, 0);
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

void CellTiles::set(const TargetField& target, double maximum, double width) {
  const double cell = kMmPerMetre * target.cell;
  const double most = std::max(target.rows, target.cols);
  int factor = static_cast<int>(std::clamp(width / cell + 1e-6, 1.0, most));
  while (ceil_div(target.rows, factor) * ceil_div(target.cols, factor) > kMaxBlocks) ++factor;
  const std::size_t rows = ceil_div(target.rows, factor), cols = ceil_div(target.cols, factor);
  const std::size_t across = ceil_div(cols, kTileCols), tiles = across * ceil_div(rows, kTileRows);
  tiles_.assign(tiles, CellTile{});
  mean_weight_.clear();
  std::optional<CellWeights> weights;
  if (!target.weight.empty()) {
    weights.emplace(target, maximum);
    mean_weight_.resize(tiles);
  }
  const auto width_of_block = static_cast<std::size_t>(factor);
  for (std::vector<double>& sums : columns_) sums.assign(across * kTileCols * width_of_block, 0.0);
  const BlockRow blocks{columns_[0].data(),
                        columns_[1].data(),
                        columns_[2].data(),
                        weights ? columns_[3].data() : nullptr,
                        width_of_block,
                        cell,
                        maximum};
  for (std::size_t row = 0; row < rows; ++row) {
    const int begin = static_cast<int>(row) * factor;
    sum_rows(target, weights ? &*weights : nullptr, begin, std::min(begin + factor, target.rows));
    const std::size_t first = row / kTileRows * across;
    fill_tiles(blocks, row % kTileRows, std::span(tiles_).subspan(first, across),
               weights ? std::span(mean_weight_).subspan(first, across)
                       : std::span<std::array<float, 8>>());
  }
  const TileSums sums = complete_tiles(tiles_, mean_weight_);
  peak_ = sums.peak;
  square_ = sums.square_norm;
}

}  // namespace prostm::planning
