/// Units, medium, grid and timer.

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/geometry.hpp"
#include "prostm/core/medium.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using namespace prostm::literals;

// a literal may differ in the last bit, by one multiplication
void expect_same(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-15 * expected);
}

TEST(Units, LiteralsAreSi) {
  expect_same(8.5_mm, 0.0085);
  expect_same(140_mm, 0.140);
  expect_same(20_ms, 0.020);
  expect_same(0.5_ms, 0.0005);
  expect_same(40_kHz, 40000.0);
  EXPECT_NEAR(kPi, std::acos(-1.0), 1e-15);
}

// Dry air at 20 °C and one atmosphere: 343.2 m/s, 1.204 kg/m³.
TEST(Medium, AirAtRoomTemperature) {
  const Medium air;
  EXPECT_NEAR(air.speed_of_sound(), 343.2, 0.05);
  EXPECT_NEAR(air.density(), 1.204, 0.0005);
}

// c at 0 °C is 331.3 m/s; c is proportional to √T, ρ to p/T, and the ideal gas has ρc² = κp.
TEST(Medium, FollowsTheIdealGas) {
  Medium air;
  air.temperature = 273.15;
  EXPECT_NEAR(air.speed_of_sound(), 331.3, 0.05);
  for (double temperature : {250.0, 293.15, 320.0}) {
    for (double pressure : {80000.0, 101325.0}) {
      const Medium other{temperature, pressure};
      const double c = other.speed_of_sound();
      EXPECT_NEAR(other.density() * c * c, 1.4 * pressure, 1e-9 * pressure);
      EXPECT_NEAR(c / Medium{}.speed_of_sound(), std::sqrt(temperature / 293.15), 1e-12);
    }
  }
}

TEST(Geometry, CrossIsPositiveCounterClockwise) {
  EXPECT_EQ(cross(Vec2(1.0, 0.0), Vec2(0.0, 2.0)), 2.0);
  EXPECT_EQ(cross(Vec2(0.0, 2.0), Vec2(1.0, 0.0)), -2.0);
  EXPECT_EQ(cross(Vec2(3.0, 1.0), Vec2(6.0, 2.0)), 0.0);
}

// Each cell and node has its own index. Indices are contiguous, x fastest, then y.
TEST(GridShape, IndicesAreContiguous) {
  const GridShape grid{3, 4, 5, 0.01, Vec3(-0.1, 0.2, 0.3)};
  EXPECT_EQ(grid.cell_count(), 60u);
  EXPECT_EQ(grid.node_count(), 120u);
  std::size_t cells = 0, nodes = 0;
  for (int k = 0; k <= grid.nz; ++k) {
    for (int j = 0; j <= grid.ny; ++j) {
      for (int i = 0; i <= grid.nx; ++i) {
        EXPECT_EQ(grid.node_index(i, j, k), nodes++);
        if (i < grid.nx && j < grid.ny && k < grid.nz) {
          EXPECT_EQ(grid.cell_index(i, j, k), cells++);
        }
      }
    }
  }
  EXPECT_EQ(cells, grid.cell_count());
  EXPECT_EQ(nodes, grid.node_count());
}

TEST(GridShape, LargeGridsDoNotOverflow) {
  const GridShape grid{2000, 2000, 2000, 0.001, Vec3::Zero()};
  EXPECT_EQ(grid.cell_count(), 8000000000u);
  EXPECT_EQ(grid.cell_index(1999, 1999, 1999), grid.cell_count() - 1);
  EXPECT_EQ(grid.node_index(2000, 2000, 2000), grid.node_count() - 1);
}

TEST(GridShape, CentresLieBetweenNodes) {
  const GridShape grid{3, 4, 5, 0.01, Vec3(-0.1, 0.2, 0.3)};
  EXPECT_TRUE(grid.node(0, 0, 0).isApprox(Vec3(-0.1, 0.2, 0.3)));
  EXPECT_TRUE(grid.node(3, 4, 5).isApprox(Vec3(-0.07, 0.24, 0.35)));
  EXPECT_TRUE(grid.cell_centre(1, 2, 3).isApprox(0.5 * (grid.node(1, 2, 3) + grid.node(2, 3, 4))));
}

TEST(GridShape, IsEqualIfEveryPartIs) {
  const GridShape grid{3, 4, 5, 0.01, Vec3(-0.1, 0.2, 0.3)};
  GridShape other = grid;
  EXPECT_TRUE(grid == other);
  other.p_DF.z() += 0.001;
  EXPECT_FALSE(grid == other);
}

TEST(StageTimer, IsMonotonicAndLapsAddUp) {
  StageTimer whole, laps;
  double previous = 0.0, sum = 0.0;
  for (int i = 0; i < 1000; ++i) {
    sum += laps.lap();
    const double now = whole.seconds();
    ASSERT_GE(now, previous);
    // the total started first and is read last
    ASSERT_LE(sum, now + 1e-9);
    previous = now;
  }
  EXPECT_GT(previous, 0.0);
  whole.restart();
  EXPECT_LT(whole.seconds(), previous + 60.0);
}

}  // namespace
}  // namespace prostm
