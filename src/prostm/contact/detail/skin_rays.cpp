#include "prostm/contact/detail/skin_rays.hpp"

#include <algorithm>
#include <limits>

namespace prostm {
namespace {

constexpr int kNone = std::numeric_limits<int>::max();  // level of a column without hand

/// Interpolates between nodes. @param q in cells from the grid's corner, inside the grid.
double between_nodes(const HandRaster& raster, const Vec3& q) {
  const GridShape& g = raster.grid;
  const int i = std::min(static_cast<int>(q.x()), g.nx - 1),
            j = std::min(static_cast<int>(q.y()), g.ny - 1),
            k = std::min(static_cast<int>(q.z()), g.nz - 1);
  const double u = q.x() - i, v = q.y() - j, w = q.z() - k;
  const float* d = raster.node_distance.data();
  const auto along_x = [&](int jj, int kk) {
    const std::size_t n = g.node_index(i, jj, kk);
    return (1 - u) * static_cast<double>(d[n]) + u * static_cast<double>(d[n + 1]);
  };
  const double below = (1 - v) * along_x(j, k) + v * along_x(j + 1, k);
  const double above = (1 - v) * along_x(j, k + 1) + v * along_x(j + 1, k + 1);
  return (1 - w) * below + w * above;
}

bool in_grid(const GridShape& g, const Vec3& q) {
  return q.x() >= 0 && q.y() >= 0 && q.z() >= 0 && q.x() <= g.nx && q.y() <= g.ny && q.z() <= g.nz;
}

double distance_at(const HandRaster& raster, const Vec3& p_D) {
  const Vec3 q = (p_D - raster.grid.p_DF) / raster.grid.cell;
  return in_grid(raster.grid, q) ? between_nodes(raster, q) : static_cast<double>(HandRaster::kFar);
}

}  // namespace

double march(const HandRaster& raster, const Vec3& start, const Vec3& direction, double t_max) {
  const double step = kMarchStep * raster.grid.cell;
  double t0 = 0.0, d0 = distance_at(raster, start);
  if (d0 < 0.0) return -1.0;
  while (t0 < t_max) {
    const double t1 = t0 + step;
    const double d1 = distance_at(raster, start + t1 * direction);
    if (d1 < 0.0) return t0 + step * d0 / (d0 - d1);
    t0 = t1;
    d0 = d1;
  }
  return -1.0;
}

SkinRays::SkinRays(const GridShape& grid) : grid_(grid) {
  const auto nx = static_cast<std::size_t>(grid.nx), ny = static_cast<std::size_t>(grid.ny);
  node_level_.assign((nx + 1) * (ny + 1), kNone);
  cell_level_.assign(nx * ny, kNone);
}

void SkinRays::set(const HandRaster& raster) noexcept {
  raster_ = &raster;
  grid_ = raster.grid;
  find_lowest_nodes();
  find_lowest_cells();
  first_ = Vec3(box_.lower[0], box_.lower[1], box_.lower[2]);
  last_ = Vec3(box_.upper[0], box_.upper[1], box_.upper[2]);
}

void SkinRays::find_lowest_nodes() noexcept {
  const CellBox& box = raster_->box;
  if (box.empty()) return;
  const auto pitch = static_cast<std::size_t>(grid_.nx + 1);
  const int count = box.upper[0] - box.lower[0] + 1;
  for (int j = box.lower[1]; j <= box.upper[1]; ++j) {
    int* level =
        &node_level_[static_cast<std::size_t>(j) * pitch + static_cast<std::size_t>(box.lower[0])];
    std::fill_n(level, count, kNone);
    // from the top down, so that the lowest remains
    for (int k = box.upper[2]; k >= box.lower[2]; --k) {
      const float* d = &raster_->node_distance[grid_.node_index(box.lower[0], j, k)];
      for (int n = 0; n < count; ++n) level[n] = d[n] < 0.0F ? k : level[n];
    }
  }
}

void SkinRays::find_lowest_cells() noexcept {
  std::fill(cell_level_.begin(), cell_level_.end(), kNone);
  box_ = CellBox();
  const CellBox& box = raster_->box;
  if (box.empty()) return;
  CellBox found{{grid_.nx, grid_.ny, grid_.nz}, {0, 0, box.upper[2]}};
  const auto pitch = static_cast<std::size_t>(grid_.nx + 1);
  for (int j = box.lower[1]; j < box.upper[1]; ++j) {
    for (int i = box.lower[0]; i < box.upper[0]; ++i) {
      const int* nodes =
          &node_level_[static_cast<std::size_t>(j) * pitch + static_cast<std::size_t>(i)];
      const int node =
          std::min(std::min(nodes[0], nodes[1]), std::min(nodes[pitch], nodes[pitch + 1]));
      if (node == kNone) continue;
      const int level = std::max(node - 1, 0), at[3] = {i, j, level};
      cell_level_[column_index(i, j)] = level;
      for (int a = 0; a < 3; ++a) found.lower[a] = std::min(found.lower[a], at[a]);
      found.upper[0] = std::max(found.upper[0], i + 1);
      found.upper[1] = std::max(found.upper[1], j + 1);
    }
  }
  if (found.upper[0] > 0) box_ = found;
}

double SkinRays::mean_of_level(int i, int j, int k) const noexcept {
  const float* near = &raster_->node_distance[grid_.node_index(i, j, k)];
  const float* far = near + grid_.nx + 1;
  return 0.25 * (static_cast<double>(near[0]) + static_cast<double>(near[1]) +
                 static_cast<double>(far[0]) + static_cast<double>(far[1]));
}

double SkinRays::column(int i, int j) const noexcept {
  constexpr double kMissed = std::numeric_limits<double>::quiet_NaN();
  int k = cell_level_[column_index(i, j)];
  if (k == kNone) return kMissed;
  // along the axis of a column the distance is linear between levels, and the floor of the lowest
  // cell is outside the hand unless the hand extends through the grid's floor
  double d0 = mean_of_level(i, j, k);
  if (d0 < 0.0) return kMissed;
  const int top = std::min(raster_->box.upper[2], grid_.nz);
  for (; k < top; ++k) {
    const double d1 = mean_of_level(i, j, k + 1);
    // march() interpolates on the same line, in steps of half a cell
    if (d1 < 0.0) return grid_.p_DF.z() + grid_.cell * (k + d0 / (d0 - d1));
    d0 = d1;
  }
  return kMissed;
}

bool SkinRays::may_be_inside(const Vec3& q) const noexcept {
  if (!(q.x() >= first_.x() && q.y() >= first_.y() && q.z() >= first_.z() && q.x() <= last_.x() &&
        q.y() <= last_.y() && q.z() <= last_.z()))
    return false;
  const int i = std::min(static_cast<int>(q.x()), grid_.nx - 1),
            j = std::min(static_cast<int>(q.y()), grid_.ny - 1);
  return static_cast<int>(q.z()) >= cell_level_[column_index(i, j)];
}

double SkinRays::distance(const Vec3& q) const noexcept {
  return in_grid(grid_, q) ? between_nodes(*raster_, q) : static_cast<double>(HandRaster::kFar);
}

Vec3 SkinRays::inwards(const Vec3& p_D) const noexcept {
  const Vec3 q = (p_D - grid_.p_DF) / grid_.cell;
  const int at[3] = {std::clamp(static_cast<int>(q.x()), 0, grid_.nx - 1),
                     std::clamp(static_cast<int>(q.y()), 0, grid_.ny - 1),
                     std::clamp(static_cast<int>(q.z()), 0, grid_.nz - 1)};
  Vec3 gradient = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int up[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
    const std::size_t node = grid_.node_index(at[0] + up[0], at[1] + up[1], at[2] + up[2]);
    const auto d = static_cast<double>(raster_->node_distance[node]);
    Vec3 share, sign;
    for (int a = 0; a < 3; ++a) {
      const double u = q[a] - at[a];
      share[a] = up[a] != 0 ? u : 1.0 - u;
      sign[a] = up[a] != 0 ? d : -d;
    }
    gradient += Vec3(sign.x() * share.y() * share.z(), sign.y() * share.z() * share.x(),
                     sign.z() * share.x() * share.y());
  }
  return -gradient.normalized();
}

double SkinRays::march(const Vec3& start, const Vec3& direction, double t_max) const noexcept {
  if (box_.empty()) return -1.0;
  const double step = kMarchStep * grid_.cell;
  const Vec3 q = (start - grid_.p_DF) / grid_.cell, along = direction / grid_.cell;
  if (may_be_inside(q) && distance(q) < 0.0) return -1.0;
  for (double t0 = 0.0; t0 < t_max;) {
    const double t1 = t0 + step;
    const Vec3 q1 = q + t1 * along;
    if (may_be_inside(q1)) {
      const double d1 = distance(q1);
      if (d1 < 0.0) {
        const double d0 = distance(q + t0 * along);
        return t0 + step * d0 / (d0 - d1);
      }
    }
    t0 = t1;
  }
  return -1.0;
}

}  // namespace prostm
