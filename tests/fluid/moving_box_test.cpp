/// A moving box: the values it carries over, and the pressure on a hand inside.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "analytic_raster.hpp"
#include "prostm/core/random.hpp"
#include "prostm/fluid/detail/carry_over.hpp"
#include "prostm/fluid/fluid.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr int kCells = 32;

// compared with code that looks up each value
TEST(MovingBox, CarriesValuesToTheirPosition) {
  const fluid::PaddedGrid grid{kCells};
  Random random(7);
  for (int round = 0; round < 40; ++round) {
    const int axis = static_cast<int>(random.uniform(0.0, 4.0));
    CellShift by;
    for (int& cells : by) cells = static_cast<int>(random.uniform(-18.0, 19.0));
    const auto count = [&](int a) { return kCells + (a == axis ? 1 : 0); };
    fluid::Field field(grid), before(grid);
    for (fluid::Index c = 0; c < grid.size(); ++c)
      field[c] = before[c] = static_cast<float>(random.uniform(-1.0, 1.0));
    {
      const test::HeapGuard guard;
      fluid::carry_over(grid, by, axis, field);
      EXPECT_EQ(guard.allocations(), 0U);
    }
    for (int k = 0; k < count(2); ++k) {
      for (int j = 0; j < count(1); ++j) {
        for (int i = 0; i < count(0); ++i) {
          const fluid::Index from = grid.index(std::clamp(i + by[0], 0, count(0) - 1),
                                               std::clamp(j + by[1], 0, count(1) - 1),
                                               std::clamp(k + by[2], 0, count(2) - 1));
          ASSERT_EQ(field[grid.index(i, j, k)], before[from]) << i << ' ' << j << ' ' << k;
        }
      }
    }
    ASSERT_EQ(field[grid.index(-1, 3, 4)], before[grid.index(-1, 3, 4)]) << "the halo is unchanged";
  }
}

SmokeInflow jet() {
  SmokeInflow inflow;
  inflow.jets = {{Vec2(0.01, -0.02), 0.024, 0.6}};
  inflow.vent_speed = 0.06;
  inflow.viscosity = 0.95e-4;
  inflow.guide_height = 0.10;
  return inflow;
}

FluidSettings small() {
  FluidSettings settings;
  settings.cells = 48;
  settings.width = 0.24;
  return settings;
}

/// The total pressure below a plate of 60 × 60 mm, whose lower side is at 0.182 m [N].
double force_on_plate(const Fluid& fluid) {
  const GridShape& g = fluid.grid();
  double force = 0.0;
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const Vec3 p = g.cell_centre(i, j, 0);
      if (std::abs(p.x() - 0.01) > 0.03 || std::abs(p.y() + 0.02) > 0.03) continue;
      const int k = static_cast<int>(std::lround((0.18 - g.p_DF.z()) / g.cell)) - 1;
      force += g.cell * g.cell * static_cast<double>(fluid.pressure()[g.cell_index(i, j, k)]);
    }
  }
  return force;
}

HandRaster plate(const GridShape& grid) {
  return test::shape_raster(grid, [](const Vec3& p) {
    return test::rounded_box(p, Vec3(0.01, -0.02, 0.192), Vec3(0.03, 0.03, 0.01), 0.004);
  });
}

/// A step of 20 ms in which the box moves.
void step_and_move(Fluid& fluid, const CellShift& by,
                   const std::function<HandRaster(const GridShape&)>& hand) {
  fluid.prepare(0.02);
  fluid.move_box(by);
  fluid.meet(hand(fluid.grid()));
  fluid.settle();
}

TEST(MovingBox, LeavesTheForceOnAHandUnchanged) {
  WorkerPool pool(2);
  Fluid still(small(), jet(), pool), moved(small(), jet(), pool);
  const Vec3 home = moved.grid().p_DF;
  const auto run = [&](Fluid& fluid, int steps) {
    const HandRaster raster = plate(fluid.grid());
    for (int step = 0; step < steps; ++step) fluid.step(0.02, raster);
    return force_on_plate(fluid);
  };
  const double settled = run(still, 100);
  run(moved, 100);
  // back and forth under the plate, which stays in the box
  double worst = 0.0;
  for (const CellShift by : {CellShift{4, 0, 0}, {0, -4, 3}, {-4, 2, 3}, {2, 4, 0}, {0, 0, -4}}) {
    step_and_move(moved, by, plate);
    for (int step = 0; step < 20; ++step) {
      worst = std::max(worst, std::abs(force_on_plate(moved) / settled - 1.0));
      run(moved, 1);
    }
  }
  EXPECT_LT(worst, 0.03);
  EXPECT_TRUE(moved.grid().p_DF.isApprox(home + 0.005 * Vec3(2, 2, 2), 1e-12));
  EXPECT_GT(settled, 1e-5);
}

TEST(MovingBox, RestartsAfterAJump) {
  WorkerPool pool(2);
  Fluid fluid(small(), jet(), pool), fresh(small(), jet(), pool);
  const HandRaster air = test::empty_raster(fluid.grid());
  for (int step = 0; step < 20; ++step) fluid.step(0.02, air);
  for (Fluid* each : {&fluid, &fresh}) {
    step_and_move(*each, {24, 0, 0}, test::empty_raster);
    step_and_move(*each, {-24, 0, 0}, test::empty_raster);
  }
  EXPECT_EQ(fluid.grid(), fresh.grid());
  for (int step = 0; step < 5; ++step) {
    fluid.step(0.02, air);
    fresh.step(0.02, air);
  }
  ASSERT_TRUE(
      std::equal(fluid.pressure().begin(), fluid.pressure().end(), fresh.pressure().begin()));
}

}  // namespace
}  // namespace prostm
