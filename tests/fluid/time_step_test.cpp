/// The error of a step of 20 ms for small objects, and the two settings that reduce it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "analytic_raster.hpp"
#include "prostm/fluid/fluid.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

SmokeInflow jet() {
  SmokeInflow inflow;
  inflow.jets = {{Vec2(0.003, -0.002), 0.019, 0.6}};
  inflow.vent_speed = 0.06;
  inflow.viscosity = 0.95e-4;
  return inflow;
}

FluidSettings small(double theta, int substeps) {
  FluidSettings settings;
  settings.cells = 48;
  settings.width = 0.12;
  settings.theta = theta;
  settings.substeps = substeps;
  return settings;
}

/// A finger across the jet, as wide as a fingertip.
HandRaster finger(const GridShape& grid) {
  return test::shape_raster(grid, [](const Vec3& p) {
    const Vec3 q(p.x(), std::max(p.y() - 0.003, 0.0), p.z() - 0.071);
    return q.norm() - 0.0076;
  });
}

/// ∫ p over the cells below the finger [N].
double force_on_finger(const Fluid& fluid) {
  const GridShape& g = fluid.grid();
  double force = 0.0;
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const Vec3 p = g.cell_centre(i, j, 0);
      const double y = std::max(p.y() - 0.003, 0.0);
      if (p.x() * p.x() + y * y > 0.0076 * 0.0076 || p.y() < -0.03) continue;
      const int k = static_cast<int>(0.06 / g.cell);
      force += g.cell * g.cell * static_cast<double>(fluid.pressure()[g.cell_index(i, j, k)]);
    }
  }
  return force;
}

double settled_force(double theta, int substeps) {
  WorkerPool pool(2);
  Fluid fluid(small(theta, substeps), jet(), pool);
  const HandRaster raster = finger(fluid.grid());
  double force = 0.0;
  for (int step = 0; step < 60; ++step) {
    fluid.step(0.02, raster);
    if (step >= 50) force += 0.1 * force_on_finger(fluid);
  }
  return force;
}

TEST(TimeStep, ThetaAndSubstepsRemoveTheSplittingError) {
  const double exact = settled_force(0.6, 4);
  EXPECT_GT(exact, 1e-5);
  const double implicit = std::abs(settled_force(1.0, 1) / exact - 1.0),
               halved = std::abs(settled_force(1.0, 2) / exact - 1.0),
               centred = std::abs(settled_force(0.6, 1) / exact - 1.0);
  EXPECT_LT(halved, 0.5 * implicit);
  EXPECT_LT(centred, 0.1 * implicit);
  EXPECT_LT(centred, 0.03);
}

// sub-steps around a finger at rest are like steps
TEST(TimeStep, SubstepsEqualSteps) {
  WorkerPool pool(2);
  for (const double theta : {1.0, 0.6}) {
    Fluid steps(small(theta, 1), jet(), pool), halves(small(theta, 2), jet(), pool);
    const HandRaster raster = finger(steps.grid());
    // before the first sub-step there is no flow
    halves.step(0.02, raster);
    steps.step(0.01, test::empty_raster(steps.grid()));
    steps.step(0.01, raster);
    for (int step = 0; step < 10; ++step) {
      {
        const test::HeapGuard guard;
        halves.step(0.02, raster);
        EXPECT_EQ(guard.allocations(), 0U);
      }
      std::vector<float> mean(steps.pressure().size());
      for (int half = 0; half < 2; ++half) {
        steps.step(0.01, raster);
        for (std::size_t c = 0; c < mean.size(); ++c) mean[c] += 0.5F * steps.pressure()[c];
      }
      for (std::size_t c = 0; c < mean.size(); ++c)
        ASSERT_NEAR(halves.pressure()[c], mean[c], 1e-6F);
    }
  }
}

/// Pressures 5 mm in front of and behind a ball that starts suddenly, over two steps: their
/// difference, which drives the air around it [Pa].
std::array<double, 2> starting_ball(double theta, int substeps) {
  WorkerPool pool(2);
  Fluid fluid(small(theta, substeps), {}, pool);
  const GridShape& g = fluid.grid();
  std::array<double, 2> out{};
  for (int step = 0; step < 2; ++step) {
    const double z = 0.061 + 0.002 * step;
    fluid.step(0.02, test::shape_raster(
                         g, [&](const Vec3& p) { return test::sphere(p, Vec3(0, 0, z), 0.015); },
                         Vec3(0, 0, 0.1)));
    const auto at = [&](double height) {
      const int middle = g.nx / 2, k = static_cast<int>(height / g.cell);
      return static_cast<double>(fluid.pressure()[g.cell_index(middle, middle, k)]);
    };
    out[static_cast<std::size_t>(step)] = at(z + 0.020) - at(z - 0.020);
  }
  return out;
}

// a jerk acts once, as strongly as in one implicit step, and does not alternate between steps
TEST(TimeStep, AJerkActsOnce) {
  const auto [first, second] = starting_ball(1.0, 1);
  EXPECT_GT(first, 0.03);
  for (const auto& [theta, substeps] :
       {std::pair(0.6, 1), std::pair(1.0, 2), std::pair(1.0, 4), std::pair(0.6, 4)}) {
    const auto [now, then] = starting_ball(theta, substeps);
    EXPECT_NEAR(now, first, 0.05 * first) << theta << ", " << substeps;
    EXPECT_NEAR(then, second, 0.10 * first) << theta << ", " << substeps;
  }
}

// where the centred form would be unstable it becomes implicit
TEST(TimeStep, ThetaIsStableAtAnySpeed) {
  WorkerPool pool(2);
  for (const double speed : {0.5, 1.0, 1.5, 2.0, 3.0}) {
    FluidSettings settings = small(0.6, 1);
    settings.jet_speed = speed;
    Fluid fluid(settings, jet(), pool);
    const HandRaster raster = finger(fluid.grid());
    double most = 0.0;
    for (int step = 0; step < 80; ++step) {
      ASSERT_FALSE(fluid.step(0.02, raster).reset);
      if (step < 30) continue;
      for (const float p : fluid.pressure())
        most = std::max(most, std::abs(static_cast<double>(p)));
    }
    const double u = 0.6 * speed;
    EXPECT_LT(most, 2.0 * 0.5 * settings.density * u * u) << "stagnation pressure of a jet";
  }
}

}  // namespace
}  // namespace prostm
