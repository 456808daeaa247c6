/// The fluid through its public interface.

#include "prostm/fluid/fluid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "analytic_raster.hpp"
#include "prostm/fluid/detail/obstacle.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "support/heap_guard.hpp"
#include "support/smoke_of.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;

FluidSettings settings_of(int cells, int cycles = 2) {
  FluidSettings settings;
  settings.cells = cells;
  settings.cycles = cycles;
  return settings;
}

SmokeInflow still_air() {
  return {};
}

HandRaster hand_at(const GridShape& grid, double z, double speed) {
  return test::shape_raster(
      grid, [&](const Vec3& p) { return test::flat_hand(p, z); }, Vec3(0, 0, speed));
}

/// Returns a hand that oscillates vertically at 1 Hz, at step t of a run.
HandRaster bobbing_hand(const GridShape& grid, int t) {
  const double phase = 2.0 * 3.14159265 * kStep * t;
  return hand_at(grid, 0.18 + 0.02 * std::sin(phase), 0.02 * 2.0 * 3.14159265 * std::cos(phase));
}

TEST(Fluid, RejectsSettingsOutOfBounds) {
  WorkerPool pool(1);
  const auto message = [&](auto change) -> std::string {
    FluidSettings settings;
    change(settings);
    try {
      Fluid fluid(settings, still_air(), pool);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message([](FluidSettings& s) { s.cells = 31; }),
            "cells = 31 must be between 32 and 160");
  EXPECT_EQ(message([](FluidSettings& s) { s.cells = 176; }),
            "cells = 176 must be between 32 and 160");
  EXPECT_EQ(message([](FluidSettings& s) { s.cycles = 0; }),
            "cycles = 0 must be between 1 and 100");
  EXPECT_THAT(message([](FluidSettings& s) { s.width = std::numeric_limits<double>::quiet_NaN(); }),
              testing::HasSubstr("width"));
  EXPECT_THAT(message([](FluidSettings& s) { s.density = 0; }),
              testing::HasSubstr("density = 0 kg/m³ must be"));
  EXPECT_THAT(message([](FluidSettings& s) { s.jacobi_sweeps = 0; }),
              testing::HasSubstr("jacobi_sweeps = 0"));
  EXPECT_THROW(scene_from_name("five-plumes"), std::invalid_argument);
  EXPECT_EQ(scene_from_name("one-plume").smoke.jets.size(), 1u);
  EXPECT_EQ(scene_from_name("four-plumes").smoke.jets.size(), 4u);
  EXPECT_TRUE(scene_from_name("still-air").smoke.jets.empty());
}

TEST(Fluid, AirAtRestStaysAtRest) {
  WorkerPool pool(1);
  Fluid fluid(settings_of(32), still_air(), pool);
  const HandRaster hand = hand_at(fluid.grid(), 0.2, 0.0);
  for (int t = 0; t < 5; ++t) {
    const FluidStats stats = fluid.step(kStep, hand);
    EXPECT_EQ(stats.max_speed, 0.0);
    EXPECT_EQ(stats.divergence_max, 0.0);
    EXPECT_GT(stats.solid_cells, 20);
  }
  for (const float p : fluid.pressure()) EXPECT_EQ(p, 0.0F);
}

/// Returns −(impulse on the sphere)/(ρ V U) after it starts suddenly with velocity U along z.
double added_mass(int cells, double radius_in_cells, const Vec3& offset_in_cells) {
  WorkerPool pool(2);
  Fluid fluid(settings_of(cells, 20), still_air(), pool);
  const GridShape& g = fluid.grid();
  const double radius = radius_in_cells * g.cell, speed = 0.1;
  const Vec3 centre = Vec3(0, 0, 0.18) + g.cell * offset_in_cells;
  const HandRaster ball = test::shape_raster(
      g, [&](const Vec3& p) { return test::sphere(p, centre, radius); }, Vec3(0, 0, speed));
  fluid.step(kStep, ball);
  // the solid's area in a cell is the closed part of its z faces; the faces of closed cells, which
  // have no pressure, are shut
  const auto pressure = [&](int i, int j, int k) {
    return static_cast<double>(fluid.pressure()[g.cell_index(i, j, k)]);
  };
  const auto open = [&](int i, int j, int k) {
    const auto d = [&](int a, int b) { return ball.node_distance[g.node_index(i + a, j + b, k)]; };
    const auto area = static_cast<double>(fluid::open_fraction(d(0, 0), d(1, 0), d(1, 1), d(0, 1)));
    const bool shut =
        area < 1.0 && k < g.nz && (pressure(i, j, k) == 0.0 || pressure(i, j, k - 1) == 0.0);
    return shut ? 0.0 : area;
  };
  double impulse = 0.0;
  for (int k = 1; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const double area = (open(i, j, k) - open(i, j, k + 1)) * g.cell * g.cell;
        impulse += pressure(i, j, k) * area * kStep;
      }
    }
  }
  const double volume = 4.0 / 3.0 * 3.14159265358979 * std::pow(radius, 3);
  return -impulse / (fluid.settings().density * volume * speed);
}

TEST(Fluid, SphereHasHalfItsVolumeOfAddedMass) {
  for (const Vec3& offset : {Vec3(0, 0, 0), Vec3(0.5, 0.5, 0.5), Vec3(0.21, -0.34, 0.13)}) {
    EXPECT_NEAR(added_mass(64, 4.4, offset), 0.5, 0.05);
    EXPECT_NEAR(added_mass(64, 7.0, offset), 0.5, 0.05);
  }
}

TEST(Fluid, PlumesStaySymmetric) {
  WorkerPool pool(2);
  const auto jet = [](double x, double y) { return SmokeJet{Vec2(x, y), 0.020, 0.8}; };
  constexpr double kAside = 0.024;
  const SmokeInflow one{{jet(0.0, 0.0)}, 0.1};
  const SmokeInflow four{
      {jet(-kAside, -kAside), jet(-kAside, kAside), jet(kAside, -kAside), jet(kAside, kAside)},
      0.1,
      1e-4,
      0.1,
      0.1};
  for (const SmokeInflow& inflow : {one, four}) {
    Fluid fluid(settings_of(48), inflow, pool);
    const HandRaster none = test::empty_raster(fluid.grid());
    for (int t = 0; t < 25; ++t) fluid.step(kStep, none);
    const int n = fluid.grid().nx;
    double asymmetry = 0.0, most = 0.0;
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          const double w = fluid.velocity(i, j, k).z();
          most = std::max(most, w);
          asymmetry = std::max(asymmetry, std::abs(w - fluid.velocity(n - 1 - i, j, k).z()));
          asymmetry = std::max(asymmetry, std::abs(w - fluid.velocity(j, i, k).z()));
        }
      }
    }
    EXPECT_GT(most, 0.2);
    EXPECT_LT(asymmetry, 1e-4 * most) << inflow.jets.size();
  }
}

TEST(Fluid, SmokeStaysBetweenZeroAndOne) {
  WorkerPool pool(2);
  FluidSettings settings = settings_of(32);
  settings.buoyancy = 1.0;
  settings.vorticity = 2.0;
  settings.dissipation = 0.5;
  Fluid fluid(settings, scene_from_name("one-plume").smoke, pool);
  for (int t = 0; t < 40; ++t) {
    EXPECT_FALSE(fluid.step(kStep, bobbing_hand(fluid.grid(), t)).reset);
    for (const float s : test::smoke_of(fluid)) {
      ASSERT_GE(s, 0.0F);
      ASSERT_LE(s, 1.00001F);
    }
  }
  const std::vector<float> smoke = test::smoke_of(fluid);
  EXPECT_GT(*std::max_element(smoke.begin(), smoke.end()), 0.5F);
}

TEST(Fluid, BuoyancyLiftsSmoke) {
  WorkerPool pool(1);
  FluidSettings heavy = settings_of(32), light = heavy;
  light.buoyancy = 2.0;
  Fluid a(heavy, scene_from_name("one-plume").smoke, pool),
      b(light, scene_from_name("one-plume").smoke, pool);
  const HandRaster none = test::empty_raster(a.grid());
  for (int t = 0; t < 40; ++t) {
    a.step(kStep, none);
    b.step(kStep, none);
  }
  EXPECT_GT(b.velocity(16, 16, 16).z(), a.velocity(16, 16, 16).z() + 0.1);
}

TEST(Fluid, ThreadsDoNotChangeAnyBit) {
  std::vector<std::vector<float>> pressures, smokes;
  for (const int threads : {1, 2, 3}) {
    WorkerPool pool(threads);
    FluidSettings settings = settings_of(48);
    settings.vorticity = 1.0;
    Fluid fluid(settings, scene_from_name("four-plumes").smoke, pool);
    for (int t = 0; t < 12; ++t) fluid.step(kStep, bobbing_hand(fluid.grid(), t));
    pressures.emplace_back(fluid.pressure().begin(), fluid.pressure().end());
    smokes.push_back(test::smoke_of(fluid));
  }
  EXPECT_EQ(pressures[0], pressures[1]);
  EXPECT_EQ(pressures[0], pressures[2]);
  EXPECT_EQ(smokes[0], smokes[1]);
  EXPECT_EQ(smokes[0], smokes[2]);
}

TEST(Fluid, JacobiWithManySweepsAgreesWithMultigrid) {
  WorkerPool pool(2);
  FluidSettings paper = settings_of(32), exact = settings_of(32, 20);
  paper.solver = PressureMethod::Jacobi;
  paper.jacobi_sweeps = 4000;
  const SmokeInflow scene = scene_from_name("one-plume").smoke;
  Fluid history(settings_of(32), scene, pool), a(paper, scene, pool), b(exact, scene, pool);
  for (int t = 0; t < 20; ++t) history.step(kStep, bobbing_hand(history.grid(), t));
  const HandRaster hand = bobbing_hand(history.grid(), 20);
  a.copy_state(history);
  b.copy_state(history);
  const FluidStats stats = a.step(kStep, hand);
  b.step(kStep, hand);
  EXPECT_LT(stats.divergence_rms, 1e-4);
  double error = 0.0, norm = 0.0;
  for (std::size_t c = 0; c < a.pressure().size(); ++c) {
    error +=
        std::pow(static_cast<double>(a.pressure()[c]) - static_cast<double>(b.pressure()[c]), 2);
    norm += std::pow(static_cast<double>(b.pressure()[c]), 2);
  }
  EXPECT_LT(std::sqrt(error / norm), 1e-3);
}

TEST(Fluid, ReportsTheRemainingDivergence) {
  WorkerPool pool(2);
  double previous = 1.0;
  for (const int cycles : {1, 2, 4}) {
    Fluid fluid(settings_of(48, cycles), scene_from_name("one-plume").smoke, pool);
    double most = 0.0;
    for (int t = 0; t < 20; ++t) {
      const FluidStats stats = fluid.step(kStep, bobbing_hand(fluid.grid(), t));
      if (t >= 5) most = std::max(most, stats.divergence_rms);
    }
    EXPECT_LT(most, 0.4 * previous) << cycles;
    EXPECT_GT(most, 0.0);
    previous = most;
  }
}

TEST(Fluid, GivesTheDivergenceOfEachCell) {
  WorkerPool pool(2);
  Fluid fluid(settings_of(32, 1), scene_from_name("one-plume").smoke, pool);
  const HandRaster no_hand = test::empty_raster(fluid.grid());
  for (int t = 0; t < 10; ++t) {
    const double reported = fluid.step(kStep, no_hand).divergence_max;
    double largest = 0.0;
    for (int c = 0; c < 32 * 32 * 32; ++c)
      largest = std::max(largest, std::abs(fluid.divergence(c % 32, c / 32 % 32, c / 1024)));
    EXPECT_NEAR(kStep * largest, reported, 1e-5 * reported + 1e-6) << t;
    EXPECT_GT(reported, 1e-4) << t;
  }
}

/// Relative rms error of a pressure against the converged one, on cells within two of the hand.
double error_beside(const Fluid& fluid, const Fluid& exact) {
  const GridShape& g = fluid.grid();
  const auto free = fluid.fluid_cells();
  double error = 0.0, norm = 0.0;
  for (int k = 2; k < g.nz - 2; ++k) {
    for (int j = 2; j < g.ny - 2; ++j) {
      for (int i = 2; i < g.nx - 2; ++i) {
        bool beside = false;
        for (const int o : {-2, -1, 1, 2}) {
          beside = beside || free[g.cell_index(i + o, j, k)] == 0 ||
                   free[g.cell_index(i, j + o, k)] == 0 || free[g.cell_index(i, j, k + o)] == 0;
        }
        const std::size_t c = g.cell_index(i, j, k);
        if (!beside || free[c] == 0) continue;
        const auto p = static_cast<double>(exact.pressure()[c]);
        error += std::pow(static_cast<double>(fluid.pressure()[c]) - p, 2);
        norm += p * p;
      }
    }
  }
  return std::sqrt(error / norm);
}

TEST(Fluid, EstimatesTheErrorOfThePressureOnHands) {
  WorkerPool pool(2);
  FluidSettings paper = settings_of(32), accurate = settings_of(32);
  paper.solver = PressureMethod::Jacobi;
  paper.jacobi_warm = true;
  accurate.solver = PressureMethod::Mgpcg;
  const SmokeInflow scene = scene_from_name("one-plume").smoke;
  for (const FluidSettings& settings : {settings_of(32, 1), settings_of(32), accurate, paper}) {
    Fluid fluid(settings, scene, pool), exact(settings_of(32, 12), scene, pool);
    std::vector<double> ratios;
    for (int t = 0; t < 35; ++t) {
      const HandRaster hand = bobbing_hand(fluid.grid(), t);
      exact.copy_state(fluid);
      exact.step(kStep, hand);
      const double estimate = fluid.step(kStep, hand).pressure_error;
      if (t >= 15) ratios.push_back(estimate / error_beside(fluid, exact));
    }
    std::sort(ratios.begin(), ratios.end());
    const double median = ratios[ratios.size() / 2];
    // conjugate gradients leave less than assumed
    EXPECT_GT(median, 0.3) << name_of(settings.solver) << ", " << settings.cycles;
    EXPECT_LT(median, settings.solver == PressureMethod::Mgpcg ? 8.0 : 3.0)
        << name_of(settings.solver) << ", " << settings.cycles;
  }
  Fluid still(settings_of(32), scene, pool);
  EXPECT_EQ(still.step(kStep, test::empty_raster(still.grid())).pressure_error, 0.0);
}

TEST(Fluid, AHandThatHasLeftHasNoEffect) {
  WorkerPool pool(1);
  const SmokeInflow scene = scene_from_name("one-plume").smoke;
  Fluid seen(settings_of(32), scene, pool), fresh(settings_of(32), scene, pool);
  for (int t = 0; t < 10; ++t) seen.step(kStep, bobbing_hand(seen.grid(), t));
  EXPECT_EQ(std::count(seen.fluid_cells().begin(), seen.fluid_cells().end(), 0) > 50, true);
  const HandRaster none = test::empty_raster(seen.grid());
  seen.step(kStep, none);  // starts with the hand of the previous step
  fresh.copy_state(seen);
  for (int t = 0; t < 3; ++t) {
    EXPECT_EQ(seen.step(kStep, none).solid_cells, 0);
    fresh.step(kStep, none);
  }
  EXPECT_TRUE(std::equal(seen.pressure().begin(), seen.pressure().end(), fresh.pressure().begin()));
  EXPECT_EQ(std::count(seen.fluid_cells().begin(), seen.fluid_cells().end(), 0), 0);
  // and the hand may return
  EXPECT_GT(seen.step(kStep, bobbing_hand(seen.grid(), 0)).solid_cells, 50);
}

TEST(Fluid, PressureIsZeroInsideTheHand) {
  WorkerPool pool(1);
  Fluid fluid(settings_of(48), scene_from_name("one-plume").smoke, pool);
  const HandRaster hand = hand_at(fluid.grid(), 0.18, 0.0);
  for (int t = 0; t < 30; ++t) fluid.step(kStep, hand);
  const GridShape& g = fluid.grid();
  const std::vector<float> smoke = test::smoke_of(fluid);
  int inside = 0;
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const std::size_t c = g.cell_index(i, j, k);
        const double d = test::flat_hand(g.cell_centre(i, j, k), 0.18);
        if (d < -g.cell) {
          ++inside;
          EXPECT_EQ(fluid.pressure()[c], 0.0F);
          EXPECT_EQ(smoke[c], 0.0F);
        }
        if (std::abs(d) <= 0.3 * g.cell) continue;
        EXPECT_EQ(fluid.fluid_cells()[c], d > 0.0 ? 1 : 0);
      }
    }
  }
  EXPECT_GT(inside, 50);
}

TEST(Fluid, TheSmokePressesOnTheSideOfTheArray) {
  WorkerPool pool(2);
  Fluid fluid(settings_of(48), scene_from_name("one-plume").smoke, pool);
  const HandRaster hand = hand_at(fluid.grid(), 0.18, 0.0);
  for (int t = 0; t < 100; ++t) fluid.step(kStep, hand);
  const GridShape& g = fluid.grid();
  const auto at = [&](double z) {
    return fluid.pressure()[g.cell_index(g.nx / 2, g.ny / 2, static_cast<int>(z / g.cell))];
  };
  EXPECT_GT(at(0.18 - 0.013 - g.cell), 0.02F);
  EXPECT_GT(at(0.18 - 0.013 - g.cell), 3.0F * std::abs(at(0.18 + 0.013 + g.cell)));
}

TEST(Fluid, AStepInPartsEqualsAStepBitForBit) {
  WorkerPool pool(2);
  FluidSettings settings = settings_of(32);
  settings.vorticity = 2.0;
  settings.buoyancy = 0.5;
  const SmokeInflow scene = scene_from_name("four-plumes").smoke;
  Fluid whole(settings, scene, pool), parts(settings, scene, pool), other(settings, scene, pool);
  const GridShape& grid = whole.grid();
  const auto copy = [](auto span) { return std::vector(span.begin(), span.end()); };
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const HandRaster none = test::empty_raster(grid);
  for (int t = 0; t < 40; ++t) {
    // hands anywhere, steps of any length, and occasional input that causes a reset
    const double dt =
        t % 13 == 12 ? std::numeric_limits<double>::quiet_NaN() : 0.01 + 0.02 * share(random);
    HandRaster hand = hand_at(grid, 0.10 + 0.15 * share(random), share(random) - 0.5);
    if (t % 11 == 10) hand.velocity[0][7] = std::numeric_limits<float>::infinity();
    const HandRaster& raster = t % 5 == 4 ? none : hand;

    const FluidStats expected = whole.step(dt, raster);
    parts.prepare(dt);
    other.step(0.02, hand_at(grid, 0.2, 0.1));  // in between, with the same worker threads
    parts.meet(raster);
    const auto pressure = copy(parts.pressure()), smoke = test::smoke_of(parts);
    const auto free = copy(parts.fluid_cells());
    const FluidStats stats = parts.settle();

    // the results that contact reads are complete before the step has settled
    ASSERT_EQ(pressure, copy(whole.pressure())) << t;
    ASSERT_EQ(smoke, test::smoke_of(whole)) << t;
    ASSERT_EQ(free, copy(whole.fluid_cells())) << t;
    ASSERT_EQ(copy(parts.pressure()), pressure) << t;
    ASSERT_EQ(test::smoke_of(parts), smoke) << t;
    EXPECT_EQ(stats.reset, expected.reset) << t;
    EXPECT_EQ(stats.reset, t % 13 == 12 || (t % 11 == 10 && t % 5 != 4)) << t;
    EXPECT_EQ(stats.divergence_rms, expected.divergence_rms) << t;
    EXPECT_EQ(stats.divergence_max, expected.divergence_max) << t;
    EXPECT_EQ(stats.max_speed, expected.max_speed) << t;
    EXPECT_EQ(stats.solid_cells, expected.solid_cells) << t;
    for (int i = 0; i < grid.nx; i += 3) {
      ASSERT_EQ(parts.velocity(i, 9, 16), whole.velocity(i, 9, 16)) << t;
    }
  }
}

TEST(Fluid, NonFiniteInputResetsToRest) {
  WorkerPool pool(1);
  Fluid fluid(settings_of(32), scene_from_name("one-plume").smoke, pool);
  const HandRaster good = hand_at(fluid.grid(), 0.18, 0.0);
  for (int t = 0; t < 5; ++t) fluid.step(kStep, good);
  const auto at_rest = [&] {
    const std::vector<float> smoke = test::smoke_of(fluid);
    return std::all_of(fluid.pressure().begin(), fluid.pressure().end(),
                       [](float p) { return p == 0.0F; }) &&
           std::all_of(smoke.begin(), smoke.end(), [](float s) { return s == 0.0F; });
  };
  HandRaster bad = good;
  bad.node_distance[bad.node_distance.size() / 2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(fluid.step(kStep, bad).reset);
  EXPECT_TRUE(at_rest());
  EXPECT_FALSE(fluid.step(kStep, good).reset);
  bad = good;
  bad.velocity[1][bad.velocity[1].size() / 2] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(fluid.step(kStep, bad).reset);
  EXPECT_TRUE(fluid.step(std::numeric_limits<double>::quiet_NaN(), good).reset);
  EXPECT_TRUE(fluid.step(0.0, good).reset);
  // finite, but impossible for air: 10⁷ m/s
  bad = hand_at(fluid.grid(), 0.18, 1e7);
  EXPECT_TRUE(fluid.step(kStep, bad).reset);
  EXPECT_TRUE(at_rest());
  EXPECT_FALSE(fluid.step(kStep, good).reset);
}

TEST(Fluid, SweptCellsTakeTheHandsVelocity) {
  WorkerPool pool(1);
  Fluid fluid(settings_of(32), still_air(), pool);
  // a palm that has passed through a slab within one step and left the box
  HandRaster raster = test::empty_raster(fluid.grid());
  const GridShape& g = fluid.grid();
  for (int a = 0; a < 3; ++a) {
    raster.box.lower[a] = 8;
    raster.box.upper[a] = 24;
  }
  for (int k = 10; k < 22; ++k) {
    for (int j = 12; j < 20; ++j) {
      for (int i = 12; i < 20; ++i) {
        raster.swept[g.cell_index(i, j, k)] = 1;
        raster.velocity[2][g.cell_index(i, j, k)] = 1.0F;
      }
    }
  }
  fluid.step(kStep, raster);
  EXPECT_GT(fluid.velocity(16, 16, 16).z(), 0.4);
  EXPECT_LT(fluid.velocity(28, 16, 16).z(), 0.0);  // air flows back around
}

TEST(Fluid, StepDoesNotAllocate) {
  WorkerPool pool(1);
  FluidSettings settings = settings_of(32);
  settings.vorticity = 1.0;
  settings.buoyancy = 1.0;
  Fluid fluid(settings, scene_from_name("four-plumes").smoke, pool);
  const HandRaster a = bobbing_hand(fluid.grid(), 0), b = bobbing_hand(fluid.grid(), 3);
  fluid.step(kStep, a);
  const test::HeapGuard guard;
  fluid.step(kStep, b);
  fluid.step(kStep, a);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Fluid, AStateOfAnotherGridIsRejected) {
  WorkerPool pool(1);
  Fluid a(settings_of(32), still_air(), pool), b(settings_of(48), still_air(), pool);
  EXPECT_THROW(a.copy_state(b), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
