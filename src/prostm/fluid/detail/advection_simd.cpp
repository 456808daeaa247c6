#include "prostm/fluid/detail/advection.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/advection_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Trilinear interpolation without gathers. Neighbouring cells come from neighbouring places: a tile
// of a few rows of one vector takes its values from a small block of shifted rows. Each row in the
// block is loaded once, contiguous, and weighted with the hat function max(0, 1 − |s − t|) of its
// shift t and the lane's own shift s, which is the trilinear weight where the row is one of the
// lane's eight corners and 0 where it is not.
HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

constexpr int kTileRows = 4;
constexpr int kMaxLanes = 16;
constexpr int kMaxTaps = 96;  // with more shifted rows, lane by lane is cheaper

/// Shifts −d of a tile's lanes, clamped so that lane + shift stays in the field's range.
struct Tile {
  int i = 0, j = 0, k = 0, rows = 0;
  alignas(64) float shift[3][kTileRows][kMaxLanes];
  int first[3] = {0, 0, 0}, last[3] = {0, 0, 0};  // shifts of the block, inclusive

  int taps() const {
    return (last[0] - first[0] + 1) * (last[1] - first[1] + 1) * (last[2] - first[2] + 1);
  }
};

/// Returns the shifts clamped so that position + shift is from `lower` to `upper`.
HWY_INLINE V clamp_shift(V shift, V position, float lower, float upper) {
  const D d;
  const V low = hn::Sub(hn::Set(d, lower), position), high = hn::Sub(hn::Set(d, upper), position);
  return hn::Min(hn::Max(shift, low), high);
}

/// Sets the range of whole shifts that the tile's lanes need along an axis.
HWY_INLINE void set_range(Tile& tile, int axis, V low, V high, float upper_shift) {
  const D d;
  const float least = hn::GetLane(hn::MinOfLanes(d, hn::Floor(low)));
  const float most = hn::GetLane(hn::MaxOfLanes(d, hn::Floor(high))) + 1.0F;
  tile.first[axis] = static_cast<int>(least);
  tile.last[axis] = static_cast<int>(std::min(most, std::max(upper_shift, least)));
}

/// max(0, 1 − |s − t|)
HWY_INLINE V hat(V s, int t) {
  const D d;
  const V distance = hn::Abs(hn::Sub(s, hn::Set(d, static_cast<float>(t))));
  return hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.0F), distance));
}

/// Weights of a row's lanes for each of the block's shifts along an axis.
struct AxisWeights {
  alignas(64) float at[kMaxTaps][kMaxLanes];
};

HWY_INLINE void set_weights(const Tile& tile, int r, int axis, AxisWeights& weights) {
  const D d;
  const V s = hn::Load(d, tile.shift[axis][r]);
  for (int t = tile.first[axis]; t <= tile.last[axis]; ++t)
    hn::Store(hat(s, t), d, weights.at[t - tile.first[axis]]);
}

/// Returns Σ weight × value over kTaps shifts along x, or over `taps` if kTaps is 0.
template <int kTaps>
HWY_INLINE V along_x(const AxisWeights& weights, const float* field, int taps) {
  const D d;
  V sum = hn::Mul(hn::Load(d, weights.at[0]), hn::LoadU(d, field));
  for (int t = 1; t < (kTaps > 0 ? kTaps : taps); ++t)
    sum = hn::MulAdd(hn::Load(d, weights.at[t]), hn::LoadU(d, field + t), sum);
  return sum;
}

/// Computes the values of kFields fields at the shifted places of row r of the tile.
template <int kFields, int kTaps>
HWY_INLINE void sum_block(const PaddedGrid& grid, const Tile& tile, int r, const AxisWeights& wx,
                          const AxisWeights& wy, const float* const* fields, float* const* out) {
  const D d;
  const V sz = hn::Load(d, tile.shift[2][r]);
  const Index own = grid.index(tile.i, tile.j + r, tile.k);
  const int taps = tile.last[0] - tile.first[0] + 1;
  V sum0 = hn::Zero(d), sum1 = hn::Zero(d), sum2 = hn::Zero(d);
  for (int tz = tile.first[2]; tz <= tile.last[2]; ++tz) {
    const V wz = hat(sz, tz);
    for (int ty = tile.first[1]; ty <= tile.last[1]; ++ty) {
      const V w = hn::Mul(wz, hn::Load(d, wy.at[ty - tile.first[1]]));
      const Index o = own + tz * grid.plane() + ty * grid.row() + tile.first[0];
      sum0 = hn::MulAdd(w, along_x<kTaps>(wx, fields[0] + o, taps), sum0);
      if constexpr (kFields == 3) {
        sum1 = hn::MulAdd(w, along_x<kTaps>(wx, fields[1] + o, taps), sum1);
        sum2 = hn::MulAdd(w, along_x<kTaps>(wx, fields[2] + o, taps), sum2);
      }
    }
  }
  hn::StoreU(sum0, d, out[0] + own);
  if constexpr (kFields == 3) {
    hn::StoreU(sum1, d, out[1] + own);
    hn::StoreU(sum2, d, out[2] + own);
  }
}

/// Sums the block of a row; the compiler knows common numbers of shifts along x.
template <int kFields>
HWY_INLINE void interpolate_row(const PaddedGrid& grid, const Tile& tile, int r,
                                const float* const* fields, float* const* out) {
  AxisWeights wx, wy;
  set_weights(tile, r, 0, wx);
  set_weights(tile, r, 1, wy);
  switch (tile.last[0] - tile.first[0] + 1) {
    case 2:
      return sum_block<kFields, 2>(grid, tile, r, wx, wy, fields, out);
    case 3:
      return sum_block<kFields, 3>(grid, tile, r, wx, wy, fields, out);
    default:
      return sum_block<kFields, 0>(grid, tile, r, wx, wy, fields, out);
  }
}

/// Does the same lane by lane, where the flow shears so much that the block would be large.
template <int kFields>
void interpolate_lanes(const PaddedGrid& grid, const Tile& tile, int r, const float* const* fields,
                       float* const* out) {
  const auto lanes = static_cast<int>(hn::Lanes(D()));
  for (int lane = 0; lane < lanes; ++lane) {
    const float x = static_cast<float>(tile.i + lane) + tile.shift[0][r][lane];
    const float y = static_cast<float>(tile.j + r) + tile.shift[1][r][lane];
    const float z = static_cast<float>(tile.k) + tile.shift[2][r][lane];
    const Index c = grid.index(tile.i + lane, tile.j + r, tile.k);
    for (int f = 0; f < kFields; ++f) out[f][c] = trilinear(grid, fields[f], x, y, z);
  }
}

/// Advects one tile; its shifts are −factor·(d[c − back] + d[c]).
template <int kFields>
HWY_INLINE void advect_tile(const PaddedGrid& grid, const Placement& place, Tile& tile,
                            float factor, Index back, const float* const displacement[3],
                            const float* const* fields, float* const* out) {
  const D d;
  const V iota = hn::Iota(d, static_cast<float>(tile.i));
  for (int axis = 0; axis < 3; ++axis) {
    V low = hn::Set(d, 1e6F), high = hn::Set(d, -1e6F);
    for (int r = 0; r < tile.rows; ++r) {
      const float* from = displacement[axis] + grid.index(tile.i, tile.j + r, tile.k);
      const V sum = hn::Add(hn::LoadU(d, from - back), hn::LoadU(d, from));
      const V position = axis == 0   ? iota
                         : axis == 1 ? hn::Set(d, static_cast<float>(tile.j + r))
                                     : hn::Set(d, static_cast<float>(tile.k));
      const V shift = clamp_shift(hn::Mul(hn::Set(d, -factor), sum), position, place.lower[axis],
                                  place.upper[axis]);
      hn::Store(shift, d, tile.shift[axis][r]);
      low = hn::Min(low, shift);
      high = hn::Max(high, shift);
    }
    // taps beyond the range have weight 0 and may not exist; along x they stay inside the row's
    // padding
    const int at = axis == 1 ? tile.j : tile.k;
    set_range(tile, axis, low, high, axis == 0 ? 1e6F : place.upper[axis] - static_cast<float>(at));
  }
  const bool block = tile.taps() <= kMaxTaps;
  for (int r = 0; r < tile.rows; ++r) {
    if (block) {
      interpolate_row<kFields>(grid, tile, r, fields, out);
    } else {
      interpolate_lanes<kFields>(grid, tile, r, fields, out);
    }
  }
}

template <int kFields>
HWY_INLINE void advect_planes(const PaddedGrid& grid, const Placement& place, float factor,
                              Index back, const float* const displacement[3],
                              const float* const* fields, float* const* out, int k0, int k1) {
  const auto step = static_cast<int>(hn::Lanes(D()));
  Tile tile;
  for (tile.k = k0; tile.k < k1; ++tile.k) {
    for (tile.j = 0; tile.j < place.count[1]; tile.j += kTileRows) {
      tile.rows = std::min(kTileRows, place.count[1] - tile.j);
      for (tile.i = 0; tile.i < grid.n; tile.i += step) {
        advect_tile<kFields>(grid, place, tile, factor, back, displacement, fields, out);
      }
    }
  }
}

void Trace(const PaddedGrid& grid, const float* const velocity[3], float* const displacement[3],
           int k0, int k1) {
  Placement place;
  for (int a = 0; a < 3; ++a) {
    place.count[a] = grid.n;
    place.upper[a] = static_cast<float>(grid.n - 1);
  }
  advect_planes<3>(grid, place, 0.25F, 0, velocity, velocity, displacement, k0, k1);
  for (int a = 0; a < 3; ++a) extend_plane(grid, displacement[a], k0, k1);
}

void Sample(const PaddedGrid& grid, const Placement& place, const float* const displacement[3],
            const float* in, float* out, int k0, int k1) {
  const Index back = place.axis < 0 ? 0 : grid.stride(place.axis);
  advect_planes<1>(grid, place, 0.5F, back, displacement, &in, &out, k0, k1);
  if (place.axis != 0) return;
  // the last face of each row stands alone
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < grid.n; ++j) {
      const Index c = grid.index(grid.n, j, k);
      const float here[3] = {static_cast<float>(grid.n), static_cast<float>(j),
                             static_cast<float>(k)};
      float from[3];
      for (int a = 0; a < 3; ++a) {
        const float d = 0.5F * (displacement[a][c - 1] + displacement[a][c]);
        from[a] = std::clamp(here[a] - d, place.lower[a], place.upper[a]);
      }
      out[c] = trilinear(grid, in, from[0], from[1], from[2]);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::fluid {
namespace {

HWY_EXPORT(Trace);
HWY_EXPORT(Sample);

void trace(const PaddedGrid& grid, const float* const velocity[3], float* const displacement[3],
           int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(Trace)(grid, velocity, displacement, k0, k1);
}
void sample(const PaddedGrid& grid, const Placement& place, const float* const displacement[3],
            const float* in, float* out, int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(Sample)(grid, place, displacement, in, out, k0, k1);
}

}  // namespace

const AdvectionKernels& fast_advection_kernels() {
  static constexpr AdvectionKernels kernels{trace, sample};
  // queried once: the query is slow in a virtual machine
  static const bool vectors = (hwy::SupportedTargets() & ~(HWY_SCALAR | HWY_EMU128)) != 0;
  return vectors ? kernels : scalar_advection_kernels();
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
