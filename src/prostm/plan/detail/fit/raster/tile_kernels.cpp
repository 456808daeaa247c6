#include "prostm/plan/detail/fit/raster/tile_kernels.hpp"

#include <bit>

#include "prostm/plan/detail/fit/raster/distances.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/plan/detail/fit/raster/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// after the line above, which includes this file once for each target
#include <hwy/highway.h>

// The code does not branch on which cells have weight, since that is hard to predict.
HWY_BEFORE_NAMESPACE();
namespace prostm::planning {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;

/// Fills the four blocks of half a tile: sums over their columns, divided by their weights.
void FillTiles(const BlockRow& blocks, std::size_t half, std::span<CellTile> tiles,
               std::span<std::array<float, 8>> mean_weight) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::RebindToSigned<decltype(d)> di;
  using W = hn::Vec<decltype(d)>;
  const auto stride = hn::Mul(hn::Iota(di, 0), hn::Set(di, static_cast<int>(blocks.factor)));
  const W one = hn::Set(d, 1.0), cell = hn::Set(d, blocks.cell);
  const W unit = hn::Set(d, blocks.cell * blocks.cell / static_cast<double>(kUnitArea));
  const auto load = [&](const double* from) HWY_ATTR {
    return blocks.factor == 1 ? hn::LoadU(d, from) : hn::GatherIndex(d, from, stride);
  };
  const auto store = [&](W value, float* to)
                         HWY_ATTR { hn::StoreU(hn::DemoteTo(df, value), df, to); };
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    for (std::size_t lane = 0; lane < 4; lane += hn::Lanes(d)) {
      const std::size_t k = 4 * half + lane, first = (4 * t + lane) * blocks.factor;
      W weight = hn::Zero(d), pressure = weight, col = weight, row = weight, count = weight;
      W index = hn::Add(hn::ConvertTo(d, stride), hn::Set(d, static_cast<double>(first)));
      for (std::size_t i = first; i < first + blocks.factor; ++i) {
        const W w = load(blocks.weight + i);
        weight = hn::Add(weight, w);
        col = hn::MulAdd(w, index, col);
        pressure = hn::Add(pressure, load(blocks.pressure + i));
        row = hn::Add(row, load(blocks.row + i));
        if (blocks.count != nullptr) count = hn::Add(count, load(blocks.count + i));
        index = hn::Add(index, one);
      }
      const W each = hn::Div(one, hn::IfThenElse(hn::Gt(weight, hn::Zero(d)), weight, one));
      store(hn::Mul(cell, hn::Mul(each, col)), tiles[t].x + k);
      store(hn::Mul(cell, hn::Mul(each, row)), tiles[t].y + k);
      store(hn::Div(hn::Mul(pressure, each), hn::Set(d, blocks.maximum)), tiles[t].pressure + k);
      store(hn::Mul(weight, unit), tiles[t].weight + k);
      if (mean_weight.empty()) continue;
      store(hn::Div(weight, hn::Max(count, one)), mean_weight[t].data() + k);
    }
  }
}

/// Returns whether any cell has weight.
HWY_INLINE bool any_counts(const CellTile& tile) {
  const D d;
  V most = hn::Zero(d);
  for (std::size_t c = 0; c < 8; c += hn::Lanes(d)) {
    most = hn::Max(most, hn::Load(d, tile.weight + c));
  }
  return hn::GetLane(hn::MaxOfLanes(d, most)) > 0.0F;
}

HWY_INLINE void enclose(CellTile& tile) {
  const D d;
  const V far = hn::Set(d, hwy::HighestValue<float>()), minus_far = hn::Neg(far);
  V low_x = far, low_y = far, high_x = minus_far, high_y = minus_far;
  for (std::size_t c = 0; c < 8; c += hn::Lanes(d)) {
    const auto counts = hn::Gt(hn::Load(d, tile.weight + c), hn::Zero(d));
    const V x = hn::Load(d, tile.x + c), y = hn::Load(d, tile.y + c);
    low_x = hn::Min(low_x, hn::IfThenElse(counts, x, far));
    low_y = hn::Min(low_y, hn::IfThenElse(counts, y, far));
    high_x = hn::Max(high_x, hn::IfThenElse(counts, x, minus_far));
    high_y = hn::Max(high_y, hn::IfThenElse(counts, y, minus_far));
  }
  const V half = hn::Set(d, 0.5F);
  high_x = hn::MaxOfLanes(d, high_x);
  high_y = hn::MaxOfLanes(d, high_y);
  const V centre_x = hn::Mul(half, hn::Add(hn::MinOfLanes(d, low_x), high_x));
  const V centre_y = hn::Mul(half, hn::Add(hn::MinOfLanes(d, low_y), high_y));
  const V dx = hn::Sub(high_x, centre_x), dy = hn::Sub(high_y, centre_y);
  tile.centre_x = hn::GetLane(centre_x);
  tile.centre_y = hn::GetLane(centre_y);
  tile.radius = hn::GetLane(hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy))));
  for (std::size_t c = 0; c < 8; c += hn::Lanes(d)) {
    const auto counts = hn::Gt(hn::Load(d, tile.weight + c), hn::Zero(d));
    hn::Store(hn::IfThenElse(counts, hn::Load(d, tile.x + c), centre_x), d, tile.x + c);
    hn::Store(hn::IfThenElse(counts, hn::Load(d, tile.y + c), centre_y), d, tile.y + c);
  }
}

TileSums CompleteTiles(std::vector<CellTile>& tiles, MeanWeights& mean_weight) {
  const D d;
  V peak = hn::Zero(d);
  TileSums sums;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    if (!any_counts(tiles[t])) continue;
    CellTile& tile = tiles[kept] = tiles[t];
    enclose(tile);
    if (!mean_weight.empty()) mean_weight[kept] = mean_weight[t];
    V square = hn::Zero(d);
    for (std::size_t c = 0; c < 8; c += hn::Lanes(d)) {
      const V pressure = hn::Load(d, tile.pressure + c);
      const V mean =
          mean_weight.empty() ? hn::Set(d, 1.0F) : hn::LoadU(d, mean_weight[kept].data() + c);
      peak = hn::Max(peak, hn::Mul(mean, pressure));
      square = hn::MulAdd(hn::Mul(hn::Load(d, tile.weight + c), pressure), pressure, square);
    }
    sums.square_norm += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, square)));
    ++kept;
  }
  tiles.resize(kept);
  if (!mean_weight.empty()) mean_weight.resize(kept);
  sums.peak = hn::GetLane(hn::MaxOfLanes(d, peak));
  return sums;
}

std::size_t ListStrongCells(const CellTile& tile, const float* mean_weight, float threshold,
                            unsigned allowed, const CellList& list) {
  const D d;
  const DI di;
  const hn::Rebind<std::uint8_t, D> bytes;
  const std::size_t step = hn::Lanes(d);
  alignas(32) float pressures[8];
  std::size_t count = 0;
  for (std::size_t c = 0; c < 8; c += step) {
    const V mean = mean_weight == nullptr ? hn::Set(d, 1.0F) : hn::LoadU(d, mean_weight + c);
    const V pressure = hn::Mul(mean, hn::Load(d, tile.pressure + c));
    hn::Store(pressure, d, pressures + c);
    const auto counts = hn::Gt(hn::Load(d, tile.weight + c), hn::Zero(d));
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::And(counts, hn::Ge(pressure, hn::Set(d, threshold))), bits);
    const unsigned found = bits[0] & (allowed >> c) & ((1U << step) - 1U);
    const auto places = hn::Add(hn::PromoteTo(di, hn::Load(bytes, kSetBits[found].data())),
                                hn::Set(di, static_cast<std::int32_t>(c)));
    hn::StoreU(hn::GatherIndex(d, tile.x, places), d, list.x + count);
    hn::StoreU(hn::GatherIndex(d, tile.y, places), d, list.y + count);
    hn::StoreU(hn::GatherIndex(d, pressures, places), d, list.pressure + count);
    count += static_cast<std::size_t>(std::popcount(found));
  }
  return count;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::planning
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::planning {
namespace {

HWY_EXPORT(FillTiles);
HWY_EXPORT(CompleteTiles);
HWY_EXPORT(ListStrongCells);

}  // namespace

void fill_tiles(const BlockRow& blocks, std::size_t half, std::span<CellTile> tiles,
                std::span<std::array<float, 8>> mean_weight) {
  HWY_DYNAMIC_DISPATCH(FillTiles)(blocks, half, tiles, mean_weight);
}

TileSums complete_tiles(std::vector<CellTile>& tiles, MeanWeights& mean_weight) {
  return HWY_DYNAMIC_DISPATCH(CompleteTiles)(tiles, mean_weight);
}

std::size_t list_strong_cells(const CellTile& tile, const float* mean_weight, float threshold,
                              unsigned allowed, const CellList& list) {
  return HWY_DYNAMIC_DISPATCH(ListStrongCells)(tile, mean_weight, threshold, allowed, list);
}

}  // namespace prostm::planning
#endif  // HWY_ONCE
