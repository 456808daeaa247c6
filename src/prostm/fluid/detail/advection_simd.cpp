#include "prostm/fluid/detail/advection.hpp"

// only vectors whose length is known at compile time, since hats are structs of vectors
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/advection_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// Trilinear interpolation without gathers. Neighbouring cells come from neighbouring places: a
// block of a few rows of one vector takes its values from a small box of shifted rows. Each shifted
// row is loaded once, contiguous, and weighted with the hat function max(0, 1 − |s − t|) of its
// shift t and the lane's own shift s, which is the trilinear weight where the row is one of the
// lane's eight corners and 0 where it is not.
HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

constexpr int kMaxLanes = 16;
constexpr int kMaxTaps = 96;  // with more shifted rows, lane by lane is cheaper

/// The placement of a field, and its displacements: factor · (d[c − back] + d[c]).
struct Particles {
  const PaddedGrid& grid;
  const Placement& place;
  const float* const* displacement;
  float factor;
  Index back;
  Index row = grid.row(), plane = grid.plane();
};

/// A few rows of one vector each, whose shifts −d lie between the whole shifts `first` and `last`.
struct Block {
  int i = 0, j = 0, k = 0, rows = 0;
  Index number = 0;  // in its row
  Index at = 0;      // of its first value
  alignas(16) std::int32_t first[4] = {0, 0, 0, 0};
  alignas(16) std::int32_t last[4] = {0, 0, 0, 0};
  bool clamped = false;  // a lane may leave the field's range

  int taps(int axis) const { return last[axis] - first[axis] + 1; }
};

Index lanes() {
  return static_cast<Index>(hn::Lanes(D()));
}

/// Index of the range of block `block` of the row that holds cell (·, j, k).
HWY_INLINE std::size_t range_index(const PaddedGrid& grid, Index block, Index j, Index k) {
  const Index across = grid.width() / lanes(), up = (grid.n + kBlockRows - 1) / kBlockRows;
  return static_cast<std::size_t>((k * up + j / kBlockRows) * across + block);
}

/// The range of the shifts −factor·d in a block.
HWY_INLINE ShiftRange range_of(const Particles& from, const Block& block,
                               const float* const d_of[3], float factor) {
  const D d;
  ShiftRange range;
  for (int axis = 0; axis < 3; ++axis) {
    const float* first = d_of[axis] + block.at;
    V low = hn::LoadU(d, first), high = low;
    for (int r = 1; r < block.rows; ++r) {
      const V v = hn::LoadU(d, first + r * from.row);
      low = hn::Min(low, v);
      high = hn::Max(high, v);
    }
    range.low[axis] = -factor * hn::GetLane(hn::MaxOfLanes(d, high));
    range.high[axis] = -factor * hn::GetLane(hn::MinOfLanes(d, low));
  }
  return range;
}

/// The whole shifts from the least to the greatest of two ranges.
HWY_INLINE void set_shifts(const ShiftRange& a, const ShiftRange& b, Block& block) {
  const hn::CappedTag<float, 4> d;
  const hn::RebindToSigned<decltype(d)> whole;
  for (std::size_t axis = 0; axis < 4; axis += hn::Lanes(d)) {
    const auto low = hn::Min(hn::Load(d, a.low + axis), hn::Load(d, b.low + axis));
    const auto high = hn::Max(hn::Load(d, a.high + axis), hn::Load(d, b.high + axis));
    hn::Store(hn::ConvertTo(whole, hn::Floor(low)), whole, block.first + axis);
    const auto above = hn::Add(hn::Floor(high), hn::Set(d, 1.0F));
    hn::Store(hn::ConvertTo(whole, above), whole, block.last + axis);
  }
}

/// Clamps the shifts of a block that may leave the range of the field.
HWY_INLINE void clamp_shifts(const Placement& place, Block& block) {
  const int begin[3] = {block.i, block.j, block.k};
  const int size[3] = {static_cast<int>(lanes()), block.rows, 1};
  block.clamped = false;
  for (int axis = 0; axis < 3; ++axis) {
    const int near = begin[axis], far = near + size[axis] - 1;
    const auto lower = static_cast<int>(place.lower[axis]),
               upper = static_cast<int>(place.upper[axis]);
    if (near + block.first[axis] >= lower && far + block.last[axis] <= upper) continue;
    block.clamped = true;
    const int first = std::clamp(block.first[axis], lower - far, upper - far);
    const int last = std::clamp(block.last[axis], lower - near, upper - near);
    // taps beyond the range have weight 0 and may not exist; along x a second one is in the row's
    // padding
    block.first[axis] = first;
    block.last[axis] = axis == 0 ? std::max(last, first + 1) : last;
  }
}

/// The shifts of the lanes of row r along an axis, clamped so that position + shift stays in the
/// field's range.
HWY_INLINE V shift_of(const Particles& from, const Block& block, int r, int axis) {
  const D d;
  const float* at = from.displacement[axis] + block.at + r * from.row;
  const V sum = hn::Add(hn::LoadU(d, at - from.back), hn::LoadU(d, at));
  const V shift = hn::Mul(hn::Set(d, -from.factor), sum);
  if (!block.clamped) return shift;
  const V position = axis == 0   ? hn::Iota(d, static_cast<float>(block.i))
                     : axis == 1 ? hn::Set(d, static_cast<float>(block.j + r))
                                 : hn::Set(d, static_cast<float>(block.k));
  const V low = hn::Sub(hn::Set(d, from.place.lower[axis]), position);
  const V high = hn::Sub(hn::Set(d, from.place.upper[axis]), position);
  return hn::Min(hn::Max(shift, low), high);
}

/// s − t
HWY_INLINE V minus(V s, int t) {
  return hn::Sub(s, hn::Set(D(), static_cast<float>(t)));
}

/// max(0, 1 − |u|)
HWY_INLINE V hat(V u) {
  const D d;
  return hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.0F), hn::Abs(u)));
}

/// Hats of two or three shifts along an axis.
struct Hats {
  V near, middle, far;
};

template <int kTaps>
HWY_INLINE Hats hats(V s, int first) {
  const D d;
  const V one = hn::Set(d, 1.0F), u = minus(s, first);
  if constexpr (kTaps == 2) return {hn::Sub(one, u), u, u};
  const V past = hn::Sub(u, one);
  return {hn::Max(hn::Zero(d), hn::Neg(past)), hn::Sub(one, hn::Abs(past)),
          hn::Max(hn::Zero(d), past)};
}

template <int kX>
HWY_INLINE V along_x(const Hats& x, const float* field) {
  const D d;
  V sum = hn::Mul(x.near, hn::LoadU(d, field));
  sum = hn::MulAdd(x.middle, hn::LoadU(d, field + 1), sum);
  if constexpr (kX == 3) sum = hn::MulAdd(x.far, hn::LoadU(d, field + 2), sum);
  return sum;
}

template <int kX, int kY>
HWY_INLINE V along_xy(const Hats& x, const Hats& y, const float* field, Index row) {
  V sum = hn::Mul(y.near, along_x<kX>(x, field));
  sum = hn::MulAdd(y.middle, along_x<kX>(x, field + row), sum);
  if constexpr (kY == 3) sum = hn::MulAdd(y.far, along_x<kX>(x, field + 2 * row), sum);
  return sum;
}

/// Interpolates with kX × kY shifts along x and y.
template <int kFields, int kX, int kY>
HWY_INLINE void sum_few(const Particles& from, const Block& block, const float* const* fields,
                        float* const* out) {
  const D d;
  const V one = hn::Set(d, 1.0F);
  const Index row = from.row, plane = from.plane;
  Index o = block.at + block.first[2] * plane + block.first[1] * row + block.first[0];
  for (int r = 0; r < block.rows; ++r, o += row) {
    const Hats x = hats<kX>(shift_of(from, block, r, 0), block.first[0]);
    const Hats y = hats<kY>(shift_of(from, block, r, 1), block.first[1]);
    V u = minus(shift_of(from, block, r, 2), block.first[2]);
    V sum0 = hn::Zero(d), sum1 = hn::Zero(d), sum2 = hn::Zero(d);
    Index shifted = o;
    for (int t = block.first[2]; t <= block.last[2]; ++t, shifted += plane) {
      const V z = hat(u);
      u = hn::Sub(u, one);
      sum0 = hn::MulAdd(z, along_xy<kX, kY>(x, y, fields[0] + shifted, row), sum0);
      if constexpr (kFields == 3) {
        sum1 = hn::MulAdd(z, along_xy<kX, kY>(x, y, fields[1] + shifted, row), sum1);
        sum2 = hn::MulAdd(z, along_xy<kX, kY>(x, y, fields[2] + shifted, row), sum2);
      }
    }
    const Index own = block.at + r * row;
    hn::StoreU(sum0, d, out[0] + own);
    if constexpr (kFields == 3) {
      hn::StoreU(sum1, d, out[1] + own);
      hn::StoreU(sum2, d, out[2] + own);
    }
  }
}

/// The same with any number of shifts.
template <int kFields>
void sum_many(const Particles& from, const Block& block, const float* const* fields,
              float* const* out) {
  const D d;
  for (int r = 0; r < block.rows; ++r) {
    const V sx = shift_of(from, block, r, 0), sy = shift_of(from, block, r, 1),
            sz = shift_of(from, block, r, 2);
    const Index own = block.at + r * from.row;
    for (int f = 0; f < kFields; ++f) {
      V sum = hn::Zero(d);
      for (int z = block.first[2]; z <= block.last[2]; ++z) {
        for (int y = block.first[1]; y <= block.last[1]; ++y) {
          const V w = hn::Mul(hat(minus(sz, z)), hat(minus(sy, y)));
          const float* row = fields[f] + own + z * from.plane + y * from.row;
          for (int x = block.first[0]; x <= block.last[0]; ++x)
            sum = hn::MulAdd(hn::Mul(w, hat(minus(sx, x))), hn::LoadU(d, row + x), sum);
        }
      }
      hn::StoreU(sum, d, out[f] + own);
    }
  }
}

/// The same lane by lane, for a flow that shears so much that the box would be large.
template <int kFields>
void sum_lanes(const Particles& from, const Block& block, const float* const* fields,
               float* const* out) {
  const D d;
  alignas(64) float shift[3][kMaxLanes];
  for (int r = 0; r < block.rows; ++r) {
    for (int axis = 0; axis < 3; ++axis) hn::Store(shift_of(from, block, r, axis), d, shift[axis]);
    for (int lane = 0; lane < static_cast<int>(lanes()); ++lane) {
      const float x = static_cast<float>(block.i + lane) + shift[0][lane];
      const float y = static_cast<float>(block.j + r) + shift[1][lane];
      const float z = static_cast<float>(block.k) + shift[2][lane];
      const Index c = block.at + r * from.row + lane;
      for (int f = 0; f < kFields; ++f) out[f][c] = trilinear(from.grid, fields[f], x, y, z);
    }
  }
}

/// Computes the values of kFields fields at the shifted places of a block.
template <int kFields>
HWY_INLINE void interpolate(const Particles& from, const Block& block, const float* const* fields,
                            float* const* out) {
  const int x = block.taps(0), y = block.taps(1);
  if (x * y * block.taps(2) > kMaxTaps) return sum_lanes<kFields>(from, block, fields, out);
  if (x == 2 && y == 2) return sum_few<kFields, 2, 2>(from, block, fields, out);
  if (x == 2 && y == 3) return sum_few<kFields, 2, 3>(from, block, fields, out);
  if (x == 3 && y == 2) return sum_few<kFields, 3, 2>(from, block, fields, out);
  if (x == 3 && y == 3) return sum_few<kFields, 3, 3>(from, block, fields, out);
  sum_many<kFields>(from, block, fields, out);
}

/// Calls f(block) for the blocks of planes [k0, k1).
template <class F>
HWY_INLINE void over_blocks(const PaddedGrid& grid, int rows, int k0, int k1, const F& f) {
  const auto step = static_cast<int>(lanes());
  Block block;
  for (block.k = k0; block.k < k1; ++block.k) {
    for (block.j = 0; block.j < rows; block.j += kBlockRows) {
      block.rows = std::min(kBlockRows, rows - block.j);
      for (block.number = 0; block.number * step < grid.n; ++block.number) {
        // the last block overlaps the one before if a row is not a whole number of vectors
        block.i = std::min(static_cast<int>(block.number) * step, grid.n - step);
        block.at = grid.index(block.i, block.j, block.k);
        f(block);
      }
    }
  }
}

void Trace(const PaddedGrid& grid, const float* const velocity[3], Displacements& moved, int k0,
           int k1) {
  Placement place;
  for (int a = 0; a < 3; ++a) {
    place.count[a] = grid.n;
    place.upper[a] = static_cast<float>(grid.n - 1);
  }
  const Particles from{grid, place, velocity, 0.25F, 0};
  float* const out[3] = {moved.at[0].data(), moved.at[1].data(), moved.at[2].data()};
  over_blocks(grid, grid.n, k0, k1, [&](Block& block) HWY_ATTR {
    const ShiftRange half = range_of(from, block, velocity, 0.5F);
    set_shifts(half, half, block);
    clamp_shifts(place, block);
    interpolate<3>(from, block, velocity, out);
    moved.ranges[range_index(grid, block.number, block.j, block.k)] =
        range_of(from, block, out, 1.0F);
  });
  for (float* d : out) extend_plane(grid, d, k0, k1);
}

void Sample(const PaddedGrid& grid, const Placement& place, const Displacements& moved,
            const float* in, float* out, int k0, int k1) {
  const float* const d[3] = {moved.at[0].data(), moved.at[1].data(), moved.at[2].data()};
  const Particles from{grid, place, d, 0.5F, place.axis < 0 ? 0 : grid.stride(place.axis)};
  const Index end = grid.n - 1;
  over_blocks(grid, place.count[1], k0, k1, [&](Block& block) HWY_ATTR {
    // the halo before the first cell and after the last one holds its copy
    const Index own[3] = {block.number, std::min<Index>(block.j, end),
                          std::min<Index>(block.k, end)};
    // along x the block before holds the cell before
    Index before[3] = {own[0], own[1], own[2]};
    if (place.axis >= 0) before[place.axis] = std::max<Index>(own[place.axis] - 1, 0);
    set_shifts(moved.ranges[range_index(grid, own[0], own[1], own[2])],
               moved.ranges[range_index(grid, before[0], before[1], before[2])], block);
    clamp_shifts(place, block);
    interpolate<1>(from, block, &in, &out);
  });
  if (place.axis != 0) return;
  // the last face of each row is computed on its own
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < grid.n; ++j) {
      const Index c = grid.index(grid.n, j, k);
      const float here[3] = {static_cast<float>(grid.n), static_cast<float>(j),
                             static_cast<float>(k)};
      float x[3];
      for (int a = 0; a < 3; ++a)
        x[a] = std::clamp(here[a] - 0.5F * (d[a][c - 1] + d[a][c]), place.lower[a], place.upper[a]);
      out[c] = trilinear(grid, in, x[0], x[1], x[2]);
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

void trace(const PaddedGrid& grid, const float* const velocity[3], Displacements& moved, int k0,
           int k1) {
  HWY_DYNAMIC_DISPATCH(Trace)(grid, velocity, moved, k0, k1);
}
void sample(const PaddedGrid& grid, const Placement& place, const Displacements& moved,
            const float* in, float* out, int k0, int k1) {
  HWY_DYNAMIC_DISPATCH(Sample)(grid, place, moved, in, out, k0, k1);
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
