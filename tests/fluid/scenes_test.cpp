/// The scenes' effect on a flat palm: the areas of the paper's Fig. 3, and four places for four
/// jets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/fluid/fluid.hpp"
#include "prostm/pipeline/scene.hpp"

namespace prostm {
namespace {

const Vec3 kHalf(0.050, 0.095, 0.0125);  // half the size of the plate [m]
const Vec3 kCentre(0.0, 0.0, 0.2125);    // its underside is 0.20 m above the array
constexpr double kRounding = 0.008;      // radius of its edges [m]

double plate_distance(const Vec3& p) {
  const Vec3 q = (p - kCentre).cwiseAbs() - (kHalf - Vec3::Constant(kRounding));
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - kRounding;
}

HandRaster plate_on(const GridShape& grid) {
  HandRaster raster;
  raster.grid = grid;
  raster.node_distance.assign(grid.node_count(), HandRaster::kFar);
  for (auto& v : raster.velocity) v.assign(grid.cell_count(), 0.0F);
  raster.swept.assign(grid.cell_count(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell_of = [&](double x) {
      return static_cast<int>(std::floor((x - grid.p_DF[axis]) / grid.cell));
    };
    raster.box.lower[axis] = cell_of(kCentre[axis] - kHalf[axis]) - 3;
    raster.box.upper[axis] = cell_of(kCentre[axis] + kHalf[axis]) + 4;
  }
  for (int k = raster.box.lower[2]; k <= raster.box.upper[2]; ++k) {
    for (int j = raster.box.lower[1]; j <= raster.box.upper[1]; ++j) {
      for (int i = raster.box.lower[0]; i <= raster.box.upper[0]; ++i) {
        raster.node_distance[grid.node_index(i, j, k)] =
            static_cast<float>(plate_distance(grid.node(i, j, k)));
      }
    }
  }
  return raster;
}

/// The mean pressure over 3 s, one cell below the plate.
struct PalmPressure {
  int nx = 0, ny = 0;
  double cell = 0.0;
  std::vector<double> mean;

  double at(int i, int j) const {
    return mean[static_cast<std::size_t>(j) * static_cast<std::size_t>(nx) +
                static_cast<std::size_t>(i)];
  }
  double largest() const { return *std::max_element(mean.begin(), mean.end()); }
  /// Area above half of the maximum [m²].
  double area() const {
    const double half = 0.5 * largest();
    return cell * cell * static_cast<double>(std::count_if(mean.begin(), mean.end(), [&](double p) {
             return p > half;
           }));
  }
};

PalmPressure pressure_on_palm(const std::string& scene, const FluidSettings& settings = {}) {
  WorkerPool pool(2);
  Fluid fluid(settings, scene_from_name(scene).smoke, pool);
  const GridShape& grid = fluid.grid();
  const HandRaster plate = plate_on(grid);
  const auto index = [&](double x) {
    return static_cast<int>(std::floor((x - grid.p_DF.x()) / grid.cell));
  };
  const int i0 = index(-kHalf.x()), i1 = index(kHalf.x()), j0 = index(-kHalf.y()),
            j1 = index(kHalf.y());
  const int k = static_cast<int>(std::floor((kCentre.z() - kHalf.z()) / grid.cell)) - 1;

  PalmPressure palm;
  palm.nx = i1 - i0 + 1;
  palm.ny = j1 - j0 + 1;
  palm.cell = grid.cell;
  palm.mean.assign(static_cast<std::size_t>(palm.nx) * static_cast<std::size_t>(palm.ny), 0.0);
  constexpr int kSettle = 100, kSteps = 150;
  for (int t = 0; t < kSettle + kSteps; ++t) {
    fluid.step(0.02, plate);
    if (t < kSettle) continue;
    std::size_t c = 0;
    for (int j = j0; j <= j1; ++j) {
      for (int i = i0; i <= i1; ++i, ++c) {
        palm.mean[c] +=
            std::max(0.0, static_cast<double>(fluid.pressure()[grid.cell_index(i, j, k)])) / kSteps;
      }
    }
  }
  return palm;
}

/// Counts connected regions above 80 % of the largest pressure.
int places(const PalmPressure& palm) {
  std::vector<int> open;
  for (int c = 0; c < palm.nx * palm.ny; ++c) {
    if (palm.mean[static_cast<std::size_t>(c)] > 0.8 * palm.largest()) open.push_back(c);
  }
  int count = 0;
  while (!open.empty()) {
    ++count;
    std::vector<int> region{open.back()};
    open.pop_back();
    while (!region.empty()) {
      const int c = region.back();
      region.pop_back();
      const auto touches = [&](int other) {
        return std::abs(other / palm.nx - c / palm.nx) <= 1 &&
               std::abs(other % palm.nx - c % palm.nx) <= 1;
      };
      const auto rest =
          std::partition(open.begin(), open.end(), [&](int other) { return !touches(other); });
      region.insert(region.end(), rest, open.end());
      open.erase(rest, open.end());
    }
  }
  return count;
}

TEST(Scenes, OnePlumeCoversAPalmAsInThePaper) {
  const PalmPressure palm = pressure_on_palm("one-plume");
  EXPECT_NEAR(palm.area() * 1e4, 88.0, 15.0);
  EXPECT_EQ(places(palm), 1);
}

TEST(Scenes, FourPlumesAreFourPlaces) {
  const PalmPressure palm = pressure_on_palm("four-plumes");
  EXPECT_NEAR(palm.area() * 1e4, 64.0, 15.0);
  EXPECT_EQ(places(palm), 4);
  EXPECT_NEAR(palm.largest() / scene_from_name("four-plumes").full_scale_pressure, 0.97, 0.05);
  // the pressure is lower in the middle between them
  EXPECT_LT(palm.at(palm.nx / 2, palm.ny / 2), 0.75 * palm.largest());
}

TEST(Scenes, FewerThinPlumesAreFewerPlacesAndReachFullScaleAlike) {
  const std::pair<const char*, int> cases[] = {{"two-plumes", 2}, {"three-plumes", 3}};
  for (const auto& [scene, count] : cases) {
    SCOPED_TRACE(scene);
    const PalmPressure palm = pressure_on_palm(scene);
    EXPECT_EQ(places(palm), count);
    EXPECT_NEAR(palm.largest() / scene_from_name(scene).full_scale_pressure, 0.97, 0.05);
  }
}

TEST(Scenes, PressureGoesWithTheSquareOfTheJetsSpeed) {
  FluidSettings slow;
  slow.jet_speed = 0.5;
  const double ratio =
      pressure_on_palm("one-plume", slow).largest() / pressure_on_palm("one-plume").largest();
  EXPECT_NEAR(ratio, 0.25, 0.08);
}

}  // namespace
}  // namespace prostm
