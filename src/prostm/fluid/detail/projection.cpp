#include "prostm/fluid/detail/projection.hpp"

#include <array>
#include <cmath>

namespace prostm::fluid {
namespace {

/// Computes the outflow of cells [begin, end) of the row at c where hands cut faces.
void cut_outflow(const PressureLevel& level, const Obstacle& obstacle, const Field velocity[3],
                 Index c, int begin, int end, float* out) {
  for (int i = begin; i < end; ++i) {
    float sum = 0.0F;
    for (int axis = 0; axis < 3; ++axis) {
      const Field& a = level.open[axis];
      const Field& u = velocity[axis];
      const Field& wall = obstacle.wall_velocity(axis);
      const Index low = c + i, high = low + level.grid.stride(axis);
      sum += (a[high] * u[high] + (1.0F - a[high]) * wall[high]) -
             (a[low] * u[low] + (1.0F - a[low]) * wall[low]);
    }
    out[i] = level.inverse[c + i] > 0.0F ? sum : 0.0F;
  }
}

/// Subtracts the gradient from n faces u; `below` is the distance from the cell above a face to the
/// one below.
void subtract_row(float* u, const float* p, Index below, float factor, int n) {
  for (int i = 0; i < n; ++i) u[i] -= factor * (p[i] - p[i - below]);
}

/// Lets shut faces in plane k of the hands' box move with their wall.
void take_wall_velocity(const PressureLevel& level, const Obstacle& obstacle, Field velocity[3],
                        int k) {
  const CellBox& box = level.box;
  if (box.empty() || k < box.lower[2] || k > box.upper[2]) return;
  for (int axis = 0; axis < 3; ++axis) {
    for (int j = box.lower[1]; j <= box.upper[1]; ++j) {
      const Index c = level.grid.index(0, j, k);
      const float* open = level.open[axis].data() + c;
      const float* wall = obstacle.wall_velocity(axis).data() + c;
      for (int i = box.lower[0]; i <= box.upper[0]; ++i) {
        if (open[i] == 0.0F) velocity[axis][c + i] = wall[i];
      }
    }
  }
}

}  // namespace

DivergenceSum divergence(const PressureLevel& level, const Obstacle& obstacle,
                         const Field velocity[3], int k, float scale, float* out) {
  const int n = level.grid.n;
  const Index row = level.grid.row(), plane = level.grid.plane();
  float outflow[PressureLevel::kMaxCells];
  // sums in 16 lanes, so that the compiler may use vectors of any width and the result stays the
  // same
  std::array<float, PaddedGrid::kLane> squares{}, largest{};
  DivergenceSum total;
  for (int j = 0; j < n; ++j) {
    const Index c = level.grid.index(0, j, k);
    const float *u = velocity[0].data() + c, *v = velocity[1].data() + c,
                *w = velocity[2].data() + c;
    for (int i = 0; i < n; ++i)
      outflow[i] = ((u[i + 1] - u[i]) + (v[i + row] - v[i])) + (w[i + plane] - w[i]);
    const RowSpan span = level.span(j, k);
    cut_outflow(level, obstacle, velocity, c, span.begin, std::min<int>(span.end, n), outflow);
    for (int i = 0; i < n; i += static_cast<int>(squares.size())) {
      for (std::size_t lane = 0; lane < squares.size(); ++lane) {
        const float x = outflow[i + static_cast<int>(lane)], size = std::abs(x);
        squares[lane] += x * x;
        largest[lane] = largest[lane] < size ? size : largest[lane];
      }
    }
    if (out == nullptr) continue;
    for (int i = 0; i < n; ++i) out[c + i] = scale * outflow[i];
  }
  for (const float sum : squares) total.squares += static_cast<double>(sum);
  for (const float most : largest) total.largest = std::max(total.largest, most);
  return total;
}

void subtract_gradient(const PressureLevel& level, const Obstacle& obstacle, const float* p,
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

}  // namespace prostm::fluid
