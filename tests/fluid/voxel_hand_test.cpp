/// Hands of whole cells, as in ref. [4].

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic_raster.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;

/// The added mass of a sphere of whole cells that starts suddenly, relative to the mass of the
/// displaced air.
double added_mass(double radius_cells, const Vec3& offset) {
  WorkerPool pool(2);
  FluidSettings settings;
  settings.hand = HandFaces::Voxels;
  settings.cycles = 40;
  Fluid fluid(settings, {}, pool);
  const GridShape& g = fluid.grid();
  const double radius = radius_cells * g.cell, speed = 0.2;
  const Vec3 centre = Vec3(0.0, 0.0, 0.18) + g.cell * offset;
  fluid.step(kStep, test::shape_raster(
                        g, [&](const Vec3& p) { return test::sphere(p, centre, radius); },
                        Vec3(0, 0, speed)));
  const auto solid = [&](int i, int j, int k) {
    return fluid.fluid_cells()[g.cell_index(i, j, k)] == 0;
  };
  double impulse = 0.0;
  int cells = 0;
  for (int k = 1; k + 1 < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        if (!solid(i, j, k)) continue;
        ++cells;
        for (const int side : {-1, 1}) {
          if (solid(i, j, k + side)) continue;
          const auto p = static_cast<double>(fluid.pressure()[g.cell_index(i, j, k + side)]);
          impulse += side * p * g.cell * g.cell * kStep;
        }
      }
    }
  }
  EXPECT_NEAR(cells, 4.0 / 3.0 * kPi * std::pow(radius_cells, 3), 0.15 * cells);
  return impulse / (settings.density * cells * std::pow(g.cell, 3) * speed);
}

TEST(VoxelHand, HasAboutHalfItsVolumeOfAddedMass) {
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), Vec3(0.21, -0.34, 0.13)}) {
    EXPECT_NEAR(added_mass(4.4, offset), 0.5, 0.12);
    EXPECT_NEAR(added_mass(7.0, offset), 0.5, 0.08);
  }
}

// a hand of cell fractions changes with every motion, a voxel hand only after a whole cell
TEST(VoxelHand, MovesByWholeCells) {
  WorkerPool pool(1);
  FluidSettings settings;
  settings.cells = 32;
  const auto pressure_of = [&](HandFaces hand, double aside) {
    settings.hand = hand;
    Fluid fluid(settings, {}, pool);
    fluid.step(kStep,
               test::shape_raster(
                   fluid.grid(),
                   [&](const Vec3& p) { return test::sphere(p, Vec3(aside, 0.0, 0.18), 0.0505); },
                   Vec3(0, 0, 0.2)));
    return std::vector<float>(fluid.pressure().begin(), fluid.pressure().end());
  };
  EXPECT_EQ(pressure_of(HandFaces::Voxels, 0.0), pressure_of(HandFaces::Voxels, 1e-6));
  EXPECT_NE(pressure_of(HandFaces::Fractions, 0.0), pressure_of(HandFaces::Fractions, 1e-6));
}

}  // namespace
}  // namespace prostm
