#include "prostm/fluid/detail/viscosity.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/viscosity.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;

/// A row of faces, and the four rows around it.
struct Rows {
  const float *own, *south, *north, *below, *above;
};

/// The new value at i, whose neighbours along the row are at `west` and `east`.
HWY_INLINE float diffused(const Rows& rows, Index i, Index west, Index east, float share) {
  const float around = (rows.own[west] + rows.own[east]) + (rows.south[i] + rows.north[i]) +
                       (rows.below[i] + rows.above[i]);
  return rows.own[i] + share * (around - 6.0F * rows.own[i]);
}

/// Computes whole vectors, the last one with zeros in the row's padding, then the row's ends.
HWY_INLINE void diffuse_row(const Rows& rows, Index count, float share, float* HWY_RESTRICT out) {
  const D d;
  const auto step = static_cast<Index>(hn::Lanes(d));
  const auto weight = hn::Set(d, share), six = hn::Set(d, 6.0F);
  for (Index i = 0; i < count; i += step) {
    const auto own = hn::Load(d, rows.own + i);
    const auto x = hn::Add(hn::LoadU(d, rows.own + i - 1), hn::LoadU(d, rows.own + i + 1));
    const auto y = hn::Add(hn::Load(d, rows.south + i), hn::Load(d, rows.north + i));
    const auto z = hn::Add(hn::Load(d, rows.below + i), hn::Load(d, rows.above + i));
    const auto rest = hn::NegMulAdd(six, own, hn::Add(hn::Add(x, y), z));
    const auto inside = hn::FirstN(d, static_cast<std::size_t>(count - i));
    hn::Store(hn::IfThenElseZero(inside, hn::MulAdd(weight, rest, own)), d, out + i);
  }
  out[0] = diffused(rows, 0, 0, 1, share);
  out[count - 1] = diffused(rows, count - 1, count - 2, count - 1, share);
}

void DiffusePlane(const PaddedGrid& grid, const Index last[3], const float* u, float share,
                  float* out, Index k) {
  const auto row = [&](Index j, Index plane) { return u + grid.index(0, j, plane); };
  const Index below = k > 0 ? k - 1 : k, above = k < last[2] ? k + 1 : k;
  for (Index j = 0; j <= last[1]; ++j) {
    const Index south = j > 0 ? j - 1 : j, north = j < last[1] ? j + 1 : j;
    diffuse_row({row(j, k), row(south, k), row(north, k), row(j, below), row(j, above)},
                last[0] + 1, share, out + grid.index(0, j, k));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>
#include <cmath>

namespace prostm::fluid {
namespace {

HWY_EXPORT(DiffusePlane);

}  // namespace

int viscous_passes(double share) {
  return static_cast<int>(std::ceil(share * 6.0 / 0.95));
}

void diffuse(const PaddedGrid& grid, int axis, const Field& u, float share, Field& out, int k) {
  if (axis == 2 && k == 0) {
    std::copy_n(u.data() + grid.index(0, 0, 0), grid.n * grid.row(),
                out.data() + grid.index(0, 0, 0));
    return;
  }
  Index last[3] = {grid.n - 1, grid.n - 1, grid.n - 1};
  ++last[axis];
  HWY_DYNAMIC_DISPATCH(DiffusePlane)(grid, last, u.data(), share, out.data(), k);
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
