#include "prostm/fluid/detail/surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace prostm::fluid {
namespace {

constexpr int kCells = 16;

/// Returns 16³ cells of 10 mm, with the device's axis in the middle.
GridShape box() {
  return {kCells, kCells, kCells, 0.01, Vec3(-0.08, -0.08, 0.0)};
}

/// Returns a jet centred on cell (10, 4).
SmokeInflow one_jet(double vent_speed) {
  SmokeInflow scene;
  scene.jets.push_back({Vec2(0.025, -0.035), 0.03, 2.0});
  scene.vent_speed = vent_speed;
  return scene;
}

TEST(Surroundings, JetsAndVentBlowThroughTheFloor) {
  const PaddedGrid grid{kCells};
  Field w(grid, -7.0F);
  Surroundings(box(), one_jet(0.25)).set_floor(w);
  EXPECT_FLOAT_EQ(w[grid.index(10, 4, 0)], 2.25F);  // on the jet's axis
  EXPECT_FLOAT_EQ(w[grid.index(13, 4, 0)], 0.25F + 2.0F * std::exp(-1.0F));
  EXPECT_EQ(w[grid.index(10, 13, 0)], 0.25F);
  EXPECT_EQ(w[grid.index(0, 15, 0)], 0.25F);
  EXPECT_EQ(w[grid.index(10, 4, 1)], -7.0F);  // all other faces
  EXPECT_EQ(w[grid.index(16, 4, 0)], -7.0F);
}

TEST(Surroundings, SupplyFreshSmokeAndTheFloorsConditions) {
  const PaddedGrid grid{kCells};
  for (const double vent_speed : {0.0, 0.25}) {
    Field smoke(grid, 0.5F);
    Surroundings(box(), one_jet(vent_speed)).set_smoke_halo(smoke);
    EXPECT_EQ(smoke[grid.index(10, 4, -1)], 1.0F);
    EXPECT_EQ(smoke[grid.index(0, 15, -1)], vent_speed > 0.0 ? 0.0F : 0.5F);
    EXPECT_EQ(smoke[grid.index(10, 4, 0)], 0.5F);
  }
}

TEST(Surroundings, CalmTheInflowThroughAnOpenSide) {
  const PaddedGrid grid{kCells};
  Field velocity[3] = {Field(grid, 1.0F), Field(grid, 0.0F), Field(grid, 3.0F)};
  for (int j = 0; j < kCells; ++j) velocity[1][grid.index(5, j, 7)] = 4.0F;
  WorkerPool pool(2);
  Surroundings(box(), one_jet(0.0)).calm_inflow(pool, velocity);

  // in through x = 0, out through the opposite side and the top
  EXPECT_EQ(velocity[0][grid.index(0, 5, 7)], 0.0F);
  EXPECT_EQ(velocity[2][grid.index(0, 5, 7)], 0.0F);
  EXPECT_EQ(velocity[2][grid.index(0, 5, 8)], 0.0F);
  EXPECT_EQ(velocity[0][grid.index(1, 5, 7)], 1.0F);
  EXPECT_EQ(velocity[0][grid.index(kCells, 5, 7)], 1.0F);
  EXPECT_EQ(velocity[2][grid.index(8, 8, kCells)], 3.0F);
  EXPECT_EQ(velocity[2][grid.index(0, 5, 0)], 3.0F);  // the jets set the floor's faces

  // in through y = 0, where the cell loses its other velocity components too
  EXPECT_EQ(velocity[1][grid.index(5, 0, 7)], 0.0F);
  EXPECT_EQ(velocity[0][grid.index(5, 0, 7)], 0.0F);
  EXPECT_EQ(velocity[0][grid.index(6, 0, 7)], 0.0F);
  EXPECT_EQ(velocity[1][grid.index(5, 1, 7)], 4.0F);
  EXPECT_EQ(velocity[0][grid.index(8, 0, 7)], 1.0F);
}

TEST(Surroundings, GuideAJetUpToACeiling) {
  const PaddedGrid grid{kCells};
  SmokeInflow inflow = one_jet(0.25);
  inflow.guide_height = 0.06;
  inflow.guide_time = 0.1;
  const Surroundings around(box(), inflow);
  const float hold = 1.0F - std::exp(-0.2F);  // for a step of 20 ms
  Field velocity[3] = {Field(grid, 1.0F), Field(grid, 1.0F), Field(grid, 0.25F)};
  WorkerPool pool(2);
  around.guide(pool, 0.02, 0.045, velocity);
  // on the axis, below 45 mm: w approaches the floor's value, u and v approach 0
  for (int k = 1; k < 8; ++k) {
    EXPECT_NEAR(velocity[2][grid.index(10, 4, k)], k < 5 ? 0.25F + hold * 2.0F : 0.25F, 1e-6F) << k;
    const float keep = k < 4 ? 1.0F - hold : 1.0F;
    EXPECT_NEAR(velocity[0][grid.index(10, 4, k)], keep, 0.03F) << k;
    EXPECT_NEAR(velocity[1][grid.index(10, 5, k)], keep, 0.03F) << k;
  }
  // the floor and the air far from the jet are unchanged
  EXPECT_EQ(velocity[2][grid.index(10, 4, 0)], 0.25F);
  EXPECT_EQ(velocity[0][grid.index(1, 14, 2)], 1.0F);

  Field still[3] = {Field(grid, 1.0F), Field(grid, 1.0F), Field(grid, 1.0F)};
  around.guide(pool, 0.02, -0.01, still);  // a hand on the floor
  Surroundings(box(), one_jet(0.25)).guide(pool, 0.02, 1.0, still);
  EXPECT_EQ(still[2][grid.index(10, 4, 2)], 1.0F);
}

TEST(Surroundings, RejectAJetOutOfBounds) {
  SmokeInflow scene = one_jet(0.0);
  scene.jets[0].radius = 0.0;
  EXPECT_THROW(Surroundings(box(), scene), std::invalid_argument);
  EXPECT_THROW(Surroundings(box(), one_jet(-1.0)), std::invalid_argument);
}

}  // namespace
}  // namespace prostm::fluid
