#pragma once
/// Hand rasters of shapes given in closed form.

#include <cmath>
#include <functional>

#include "prostm/hand/hand_raster.hpp"

namespace prostm::test {

inline HandRaster empty_raster(const GridShape& grid) {
  HandRaster raster;
  raster.grid = grid;
  raster.node_distance.assign(grid.node_count(), HandRaster::kFar);
  for (auto& v : raster.velocity) v.assign(grid.cell_count(), 0.0F);
  raster.swept.assign(grid.cell_count(), 0);
  return raster;
}

/// Rasters a shape by its signed distance [m], moving at one velocity [m/s]; the box is the grid.
inline HandRaster shape_raster(const GridShape& grid,
                               const std::function<double(const Vec3&)>& distance,
                               const Vec3& velocity = Vec3::Zero()) {
  HandRaster raster = empty_raster(grid);
  for (int a = 0; a < 3; ++a) raster.box.upper[a] = grid.nx;
  for (int k = 0; k <= grid.nz; ++k) {
    for (int j = 0; j <= grid.ny; ++j) {
      for (int i = 0; i <= grid.nx; ++i) {
        raster.node_distance[grid.node_index(i, j, k)] =
            static_cast<float>(distance(grid.node(i, j, k)));
      }
    }
  }
  for (int a = 0; a < 3; ++a) {
    std::fill(raster.velocity[a].begin(), raster.velocity[a].end(),
              static_cast<float>(velocity[a]));
  }
  return raster;
}

inline double sphere(const Vec3& p, const Vec3& centre, double radius) {
  return (p - centre).norm() - radius;
}

inline double rounded_box(const Vec3& p, const Vec3& centre, const Vec3& half, double round) {
  const Vec3 q = (p - centre).cwiseAbs() - half + Vec3::Constant(round);
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - round;
}

/// Returns the distance to a flat hand at height z above the array's centre: palm, four fingers.
inline double flat_hand(const Vec3& p, double z) {
  double d = rounded_box(p, Vec3(0, -0.02, z), Vec3(0.045, 0.05, 0.013), 0.01);
  for (int finger = 0; finger < 4; ++finger) {
    const Vec3 a(-0.033 + 0.022 * finger, 0.02, z), b = a + Vec3(0, 0.09, 0);
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    d = std::min(d, (p - a - t * (b - a)).norm() - 0.009);
  }
  return d;
}

}  // namespace prostm::test
