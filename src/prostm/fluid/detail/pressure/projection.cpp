#include "prostm/fluid/detail/pressure/projection.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prostm/fluid/detail/pressure/projection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace prostm::fluid {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;

/// Computes the outflow of cells [begin, end) of the row at c where hands cut faces.
HWY_INLINE void cut_outflow(const PressureLevel& level, const Obstacle& obstacle,
                            const Field velocity[3], Index c, int begin, int end, float* out) {
  float sum[PressureLevel::kMaxCells] = {};
  for (int axis = 0; axis < 3; ++axis) {
    const Index s = level.grid.stride(axis);
    const float *a = level.open[axis].data() + c, *u = velocity[axis].data() + c,
                *wall = obstacle.wall_velocity(axis).data() + c;
    for (int i = begin; i < end; ++i) {
      sum[i] += (a[i + s] * u[i + s] + (1.0F - a[i + s]) * wall[i + s]) -
                (a[i] * u[i] + (1.0F - a[i]) * wall[i]);
    }
  }
  const float* inverse = level.inverse.data() + c;
  for (int i = begin; i < end; ++i) out[i] = inverse[i] > 0.0F ? sum[i] : 0.0F;
}

/// Subtracts the gradient from n faces u; `below` is the distance from the cell above a face to the
/// one below.
HWY_INLINE void subtract_row(float* u, const float* p, Index below, float factor, int n) {
  for (int i = 0; i < n; ++i) u[i] -= factor * (p[i] - p[i - below]);
}

/// Gives the shut faces in plane k of the hands' box the velocity of their wall.
void take_wall_velocity(const PressureLevel& level, const Obstacle& obstacle, Field velocity[3],
                        int k) {
  const CellBox& box = level.box;
  if (box.empty() || k < box.lower[2] || k > box.upper[2]) return;
  for (int axis = k < box.upper[2] ? 0 : 2; axis < 3; ++axis) {
    for (int j = box.lower[1]; j < box.upper[1] + (axis == 1); ++j) {
      const RowSpan cut = level.face_span(axis, j, k);
      const Index c = level.grid.index(0, j, k);
      const float* open = level.open[axis].data() + c;
      const float* wall = obstacle.wall_velocity(axis).data() + c;
      float* u = velocity[axis].data() + c;
      for (int i = cut.begin; i <= cut.end && !cut.empty(); ++i)
        u[i] = open[i] == 0.0F ? wall[i] : u[i];
    }
  }
}

/// Sums of outflows, with the same number of lanes on every processor so that totals are the same.
struct LaneSums {
  alignas(64) float squares[PaddedGrid::kLane] = {}, largest[PaddedGrid::kLane] = {};
};

/// Adds a row of n outflows, beyond which there are zeros up to a multiple of kLane.
HWY_INLINE void add_row(const float* outflow, Index n, LaneSums& sums) {
  const D d;
  for (Index lane = 0; lane < PaddedGrid::kLane; lane += static_cast<Index>(hn::Lanes(d))) {
    auto squares = hn::Load(d, sums.squares + lane), largest = hn::Load(d, sums.largest + lane);
    for (Index i = lane; i < n; i += PaddedGrid::kLane) {
      const auto x = hn::Load(d, outflow + i);
      squares = hn::Add(squares, hn::Mul(x, x));
      largest = hn::Max(largest, hn::Abs(x));
    }
    hn::Store(squares, d, sums.squares + lane);
    hn::Store(largest, d, sums.largest + lane);
  }
}

DivergenceSum Divergence(const PressureLevel& level, const Obstacle& obstacle,
                         const Field velocity[3], int k, float scale, float* out) {
  const int n = level.grid.n;
  const Index row = level.grid.row(), plane = level.grid.plane();
  alignas(64) float outflow[PressureLevel::kMaxCells] = {};
  LaneSums sums;
  for (int j = 0; j < n; ++j) {
    const Index c = level.grid.index(0, j, k);
    const float *u = velocity[0].data() + c, *v = velocity[1].data() + c,
                *w = velocity[2].data() + c;
    for (int i = 0; i < n; ++i)
      outflow[i] = ((u[i + 1] - u[i]) + (v[i + row] - v[i])) + (w[i + plane] - w[i]);
    const RowSpan span = level.span(j, k);
    if (!span.empty())
      cut_outflow(level, obstacle, velocity, c, span.begin, std::min<int>(span.end, n), outflow);
    add_row(outflow, n, sums);
    if (out == nullptr) continue;
    for (int i = 0; i < n; ++i) out[c + i] = scale * outflow[i];
  }
  DivergenceSum total;
  for (const float sum : sums.squares) total.squares += static_cast<double>(sum);
  for (const float most : sums.largest) total.largest = std::max(total.largest, most);
  return total;
}

void SubtractGradient(const PressureLevel& level, const Obstacle& obstacle, const float* p,
                      float factor, Field velocity[3], int k) {
  const int n = level.grid.n;
  const Index row = level.grid.row(), plane = level.grid.plane();
  const float side = 2.0F * factor;
  for (int j = 0; j < n; ++j) {
    const Index c = level.grid.index(0, j, k);
    float *u = velocity[0].data() + c, *v = velocity[1].data() + c, *w = velocity[2].data() + c;
    const float* q = p + c;
    u[0] -= side * q[0];
    subtract_row(u + 1, q + 1, 1, factor, n - 1);
    u[n] += side * q[n - 1];
    subtract_row(v, q, row, j == 0 ? side : factor, n);
    if (j == n - 1) subtract_row(v + row, q + row, row, side, n);
    if (k > 0) subtract_row(w, q, plane, factor, n);
    if (k == n - 1) subtract_row(w + plane, q + plane, plane, side, n);
  }
  take_wall_velocity(level, obstacle, velocity, k);
  if (k == n - 1) take_wall_velocity(level, obstacle, velocity, n);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace prostm::fluid
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace prostm::fluid {
namespace {

HWY_EXPORT(Divergence);
HWY_EXPORT(SubtractGradient);

}  // namespace

DivergenceSum divergence(const PressureLevel& level, const Obstacle& obstacle,
                         const Field velocity[3], int k, float scale, float* out) {
  return HWY_DYNAMIC_DISPATCH(Divergence)(level, obstacle, velocity, k, scale, out);
}

void subtract_gradient(const PressureLevel& level, const Obstacle& obstacle, const float* p,
                       float factor, Field velocity[3], int k) {
  HWY_DYNAMIC_DISPATCH(SubtractGradient)(level, obstacle, p, factor, velocity, k);
}

}  // namespace prostm::fluid
#endif  // HWY_ONCE
