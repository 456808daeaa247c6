/// Viscous and guided jets: their similarity law, and the effect of viscosity and guide.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analytic_raster.hpp"
#include "prostm/fluid/fluid.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

SmokeInflow jet(double viscosity, double guide_height) {
  SmokeInflow inflow;
  inflow.jets = {{Vec2(0.01, -0.02), 0.024, 0.6}};
  inflow.vent_speed = 0.06;
  inflow.viscosity = viscosity;
  inflow.guide_height = guide_height;
  return inflow;
}

FluidSettings small(double jet_speed = 1.0) {
  FluidSettings settings;
  settings.cells = 48;
  settings.jet_speed = jet_speed;
  return settings;
}

// (U, W, ν) × s, τ / s and Δt / s are the same flow, with pressures × s²
TEST(GuidedJet, IsSimilarAtAnotherSpeed) {
  WorkerPool pool(2);
  Fluid slow(small(), jet(0.8e-4, 0.1), pool), fast(small(2.0), jet(0.8e-4, 0.1), pool);
  const HandRaster air = test::empty_raster(slow.grid());
  for (int step = 0; step < 40; ++step) {
    slow.step(0.02, air);
    fast.step(0.01, air);
  }
  double most = 0.0, worst = 0.0;
  for (std::size_t c = 0; c < slow.pressure().size(); ++c) {
    const double p = 4.0 * static_cast<double>(slow.pressure()[c]);
    most = std::max(most, std::abs(p));
    worst = std::max(worst, std::abs(p - static_cast<double>(fast.pressure()[c])));
  }
  EXPECT_GT(most, 1e-3);
  EXPECT_LT(worst, 1e-4 * most);
}

/// Upward speed at a height, on the jet's axis and off it, after 2 s.
struct Speeds {
  double axis, beside;
};
Speeds speeds_at(double height, double viscosity, double guide_height) {
  WorkerPool pool(2);
  Fluid fluid(small(), jet(viscosity, guide_height), pool);
  const GridShape& grid = fluid.grid();
  const HandRaster air = test::empty_raster(grid);
  for (int step = 0; step < 100; ++step) fluid.step(0.02, air);
  const auto at = [&](double x) {
    const Vec3 q = (Vec3(x, -0.02, height) - grid.p_DF) / grid.cell;
    return fluid.velocity(static_cast<int>(q.x()), static_cast<int>(q.y()), static_cast<int>(q.z()))
        .z();
  };
  return {at(0.01), at(0.05)};
}

TEST(GuidedJet, KeepsItsSpeedUpToTheEndOfTheGuide) {
  const Speeds guided = speeds_at(0.08, 0.8e-4, 0.1), freely = speeds_at(0.08, 0.8e-4, 0.0);
  EXPECT_NEAR(guided.axis, 0.66, 0.06);
  EXPECT_LT(std::abs(guided.axis - 0.66), std::abs(freely.axis - 0.66));
}

TEST(GuidedJet, WidensWithViscosity) {
  const Speeds thin = speeds_at(0.2, 0.0, 0.0), thick = speeds_at(0.2, 3e-4, 0.0);
  EXPECT_GT(thick.beside, thin.beside);
  EXPECT_LT(thick.axis, thin.axis);
}

TEST(GuidedJet, ChangesWithTheNextStepWithoutAllocation) {
  WorkerPool pool(1);
  Fluid changed(small(), jet(0.0, 0.0), pool), fresh(small(), jet(0.0, 0.0), pool);
  SmokeInflow other = jet(0.5e-4, 0.05);
  other.jets[0].centre = Vec2(-0.03, 0.03);
  const HandRaster air = test::empty_raster(changed.grid());
  {
    const test::HeapGuard guard;
    changed.set_inflow(other);
    EXPECT_EQ(guard.allocations(), 0u);
  }
  for (int step = 0; step < 10; ++step) {
    changed.step(0.02, air);
    fresh.step(0.02, air);
  }
  const auto smoke_over = [](const Fluid& fluid, const Vec2& p) {
    const Vec2 q = (p - fluid.grid().p_DF.head<2>()) / fluid.grid().cell;
    return fluid.smoke_row(static_cast<int>(q.y()), 2)[static_cast<std::size_t>(q.x())];
  };
  EXPECT_GT(smoke_over(changed, other.jets[0].centre), 0.5F);
  EXPECT_LT(smoke_over(changed, Vec2(0.01, -0.02)), 0.1F);
  EXPECT_GT(smoke_over(fresh, Vec2(0.01, -0.02)), 0.5F);
}

TEST(GuidedJet, RejectsSettingsOutOfBounds) {
  WorkerPool pool(1);
  EXPECT_THROW(Fluid(small(), jet(-1e-5, 0.0), pool), std::invalid_argument);
  EXPECT_THROW(Fluid(small(), jet(0.0, 6.0), pool), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
