#include "prostm/fluid/detail/advection.hpp"

#include <cmath>

namespace prostm::fluid {
namespace {

void trace(const PaddedGrid& grid, const float* const velocity[3], Displacements& moved, int k0,
           int k1) {
  const auto last = static_cast<float>(grid.n - 1);
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < grid.n; ++j) {
      for (int i = 0; i < grid.n; ++i) {
        const Index c = grid.index(i, j, k);
        const float x = std::clamp(static_cast<float>(i) - 0.5F * velocity[0][c], 0.0F, last);
        const float y = std::clamp(static_cast<float>(j) - 0.5F * velocity[1][c], 0.0F, last);
        const float z = std::clamp(static_cast<float>(k) - 0.5F * velocity[2][c], 0.0F, last);
        for (int a = 0; a < 3; ++a) moved.at[a][c] = trilinear(grid, velocity[a], x, y, z);
      }
    }
  }
  for (int a = 0; a < 3; ++a) extend_plane(grid, moved.at[a].data(), k0, k1);
}

void sample(const PaddedGrid& grid, const Placement& place, const Displacements& moved,
            const float* in, float* out, int k0, int k1) {
  const Index back = place.axis < 0 ? 0 : grid.stride(place.axis);
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < place.count[1]; ++j) {
      for (int i = 0; i < place.count[0]; ++i) {
        const Index c = grid.index(i, j, k);
        const float here[3] = {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)};
        float from[3];
        for (int a = 0; a < 3; ++a) {
          const float d = 0.5F * (moved.at[a][c - back] + moved.at[a][c]);
          from[a] = std::clamp(here[a] - d, place.lower[a], place.upper[a]);
        }
        out[c] = trilinear(grid, in, from[0], from[1], from[2]);
      }
    }
  }
}

/// Blocks of the narrowest vector, of 4 floats.
std::size_t block_count(const PaddedGrid& grid) {
  constexpr int kLeastLanes = 4;
  return static_cast<std::size_t>(grid.n * ((grid.n + kBlockRows - 1) / kBlockRows)) *
         static_cast<std::size_t>(grid.width() / kLeastLanes);
}

}  // namespace

Displacements::Displacements(const PaddedGrid& grid)
    : at{Field(grid), Field(grid), Field(grid)}, ranges(block_count(grid)) {}

Placement face_placement(int n, int axis) {
  Placement place;
  place.axis = axis;
  for (int a = 0; a < 3; ++a) {
    place.count[a] = a == axis ? n + 1 : n;
    place.upper[a] = static_cast<float>(place.count[a] - 1);
  }
  return place;
}

Placement centre_placement(int n) {
  Placement place;
  for (int a = 0; a < 3; ++a) {
    place.count[a] = n;
    place.lower[a] = -1.0F;
    place.upper[a] = static_cast<float>(n);
  }
  return place;
}

float trilinear(const PaddedGrid& grid, const float* field, float x, float y, float z) {
  // at the upper end the second corner has weight 0 and may lie beyond the array: step back if it
  // does
  const auto base = [](float v) { return std::floor(v); };
  const auto top = static_cast<float>(grid.n);
  const float bx = base(x), by = std::min(base(y), top - 1.0F), bz = std::min(base(z), top - 1.0F);
  const float fx = x - bx, fy = y - by, fz = z - bz;
  const float* p =
      field + grid.index(static_cast<Index>(bx), static_cast<Index>(by), static_cast<Index>(bz));
  const Index row = grid.row(), plane = grid.plane();
  const auto along_x = [&](Index o) { return (1.0F - fx) * p[o] + fx * p[o + 1]; };
  const float near = (1.0F - fy) * along_x(0) + fy * along_x(row);
  const float far = (1.0F - fy) * along_x(plane) + fy * along_x(plane + row);
  return (1.0F - fz) * near + fz * far;
}

void extend_plane(const PaddedGrid& grid, float* field, int k0, int k1) {
  const int n = grid.n;
  for (int k = k0; k < k1; ++k) {
    for (int j = 0; j < n; ++j) {
      float* row = field + grid.index(0, j, k);
      row[-1] = row[0];
      row[n] = row[n - 1];
    }
    std::copy_n(field + grid.index(-1, 0, k), n + 2, field + grid.index(-1, -1, k));
    std::copy_n(field + grid.index(-1, n - 1, k), n + 2, field + grid.index(-1, n, k));
  }
  // the outermost planes belong to the owner of their neighbours
  if (k0 == 0)
    std::copy_n(field + grid.index(-1, -1, 0), grid.plane(), field + grid.index(-1, -1, -1));
  if (k1 == n)
    std::copy_n(field + grid.index(-1, -1, n - 1), grid.plane(), field + grid.index(-1, -1, n));
}

const AdvectionKernels& scalar_advection_kernels() {
  static constexpr AdvectionKernels kernels{trace, sample};
  return kernels;
}

}  // namespace prostm::fluid
