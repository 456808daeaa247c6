#pragma once
/// Points, poses and the regular 3-D grid. Frames by letter: D the device (origin at the array's
/// centre, z out of the array), T the tracker, H the hand, P the target plane, F the fluid grid.
/// p_DF is a position in D, X_DP a pose of P in D.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstddef>

namespace prostm {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Quat = Eigen::Quaterniond;
using Pose = Eigen::Isometry3d;  ///< X_AB maps coordinates in B to coordinates in A.

/// 2-D cross product a × b, > 0 if b is counter-clockwise from a.
inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// An axis-aligned grid of cubic cells in frame D; cell (i, j, k) spans origin + h·[i, i+1] × [j,
/// j+1] × [k, k+1]. Linear index = (k·ny + j)·nx + i: x is fastest, z points out of the array.
struct GridShape {
  int nx = 0, ny = 0, nz = 0;  ///< cells along x, y, z
  double cell = 0.0;           ///< edge of a cell h [m]
  Vec3 p_DF = Vec3::Zero();    ///< corner of cell (0, 0, 0) [m]

  std::size_t cell_count() const {
    return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny) *
           static_cast<std::size_t>(nz);
  }
  std::size_t cell_index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(ny) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(i);
  }
  /// Nodes are the corners of cells: (nx+1)(ny+1)(nz+1) of them.
  std::size_t node_count() const {
    return static_cast<std::size_t>(nx + 1) * static_cast<std::size_t>(ny + 1) *
           static_cast<std::size_t>(nz + 1);
  }
  std::size_t node_index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(ny + 1) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(nx + 1) +
           static_cast<std::size_t>(i);
  }
  Vec3 cell_centre(int i, int j, int k) const {
    return p_DF + cell * Vec3(i + 0.5, j + 0.5, k + 0.5);
  }
  Vec3 node(int i, int j, int k) const { return p_DF + cell * Vec3(i, j, k); }
  bool operator==(const GridShape&) const = default;
};

/// Whole cells along x, y and z.
using CellShift = std::array<int, 3>;

/// A vector in whole cells, rounded.
inline CellShift whole_cells(const Vec3& vector, double cell) {
  CellShift cells;
  for (int a = 0; a < 3; ++a)
    cells[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(vector[a] / cell));
  return cells;
}

}  // namespace prostm
