#include "prostm/plan/detail/paper/costs.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "prostm/core/random.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/paper/refine.hpp"

namespace prostm {
namespace {

using namespace planning;

constexpr int kSamples = 20, kPaths = 4;

/// Returns four irregular loops on the raster of the generated fields, or random points on it [mm].
std::vector<Vec2> random_paths(Random& random, bool loops) {
  std::vector<Vec2> x;
  for (int k = 0; k < kPaths; ++k) {
    const Vec2 centre(random.uniform(30, 130), random.uniform(30, 130));
    for (int i = 0; i < kSamples; ++i) {
      const double angle = 2.0 * kPi * i / kSamples;
      const Vec2 noise(3.0 * random.normal(), 3.0 * random.normal());
      x.push_back(loops ? Vec2(centre + 20.0 * Vec2(std::cos(angle), std::sin(angle)) + noise)
                        : Vec2(random.uniform(0, 160), random.uniform(0, 160)));
    }
  }
  return x;
}

/// A cost of the samples, which also adds its gradient.
using Cost = std::function<double(std::span<const Vec2>, std::span<Vec2>)>;

struct NamedCost {
  const char* name;
  Cost cost;
};

std::vector<NamedCost> all_costs(const PressureRaster& raster, Refiner& refiner) {
  return {
      {"pressure",
       [&](auto x, auto g) {
         return pressure_cost(raster, {x, kSamples}, 3.0, g);
       }},
      {"length",
       [](auto x, auto g) {
         return length_cost({x, kSamples}, 7.0, 3.0, g);
       }},
      {"intersection",
       [](auto x, auto g) {
         std::vector<SamplePair> pairs;
         near_pairs({x, kSamples}, 1e3, pairs);
         return intersection_cost({x, kSamples}, pairs, 8.6, 1.0, g);
       }},
      {"bending",
       [](auto x, auto g) {
         return bending_cost({x, kSamples}, 0.3, g);
       }},
      {"total", [&](auto x, auto g) { return refiner.evaluate(raster, x, g); }},
  };
}

std::vector<Vec2> gradient_of(const Cost& cost, std::span<const Vec2> x) {
  std::vector<Vec2> gradient(x.size(), Vec2::Zero());
  cost(x, gradient);
  return gradient;
}

TEST(Costs, GradientsAgreeWithCentralDifferences) {
  constexpr double kStep = 1e-4;  // [mm]
  Random random(11);
  Refiner refiner(CostSettings(PlanSettings{}), kPaths, kSamples, 0);
  PressureRaster raster(fields::kCells * fields::kCells);
  for (int trial = 0; trial < 24; ++trial) {
    const TargetField field = fields::make(
        fields::kPatterns[static_cast<std::size_t>(trial) % fields::kPatterns.size()], trial);
    raster.set(field, max_pressure(field));
    std::vector<Vec2> x = random_paths(random, trial % 2 == 0);
    for (const NamedCost& entry : all_costs(raster, refiner)) {
      const std::vector<Vec2> gradient = gradient_of(entry.cost, x);
      std::vector<Vec2> ignored(x.size(), Vec2::Zero());
      double error = 0.0, norm = 0.0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
          const double at = x[i][axis];
          // five-point differences of fourth order, so that the truncation error stays below the
          // bound
          double difference = 0.0;
          for (const auto& [offset, weight] :
               {std::pair(1.0, 8.0), {-1.0, -8.0}, {2.0, -1.0}, {-2.0, 1.0}}) {
            x[i][axis] = at + offset * kStep;
            difference += weight * entry.cost(x, ignored) / (12.0 * kStep);
          }
          x[i][axis] = at;
          error = std::max(error, std::abs(difference - gradient[i][axis]));
          norm = std::max(norm, std::abs(gradient[i][axis]));
        }
      }
      EXPECT_GT(norm, 0.0) << entry.name;
      EXPECT_LE(error, 1e-6 * norm) << entry.name << ", trial " << trial;
    }
  }
}

TEST(Costs, RotatingPathsAndFieldTogetherChangesNothing) {
  Random random(12);
  Refiner refiner(CostSettings(PlanSettings{}), kPaths, kSamples, 0);
  Refiner turned_refiner(CostSettings(PlanSettings{}), kPaths, kSamples, 0);
  PressureRaster raster(fields::kCells * fields::kCells),
      turned_raster(fields::kCells * fields::kCells);
  for (int trial = 0; trial < 16; ++trial) {
    const TargetField field = fields::make(
        fields::kPatterns[static_cast<std::size_t>(trial) % fields::kPatterns.size()], trial);
    raster.set(field, max_pressure(field));
    turned_raster.set(fields::rotated(field), max_pressure(field));
    const std::vector<Vec2> x = random_paths(random, trial % 2 == 0);
    const double height = 1e3 * field.cell * (field.rows - 1);
    std::vector<Vec2> turned;
    for (const Vec2& p : x) turned.push_back(Vec2(height - p.y(), p.x()));

    const auto costs = all_costs(raster, refiner),
               turned_costs = all_costs(turned_raster, turned_refiner);
    for (std::size_t c = 0; c < costs.size(); ++c) {
      std::vector<Vec2> g(x.size(), Vec2::Zero()), h(x.size(), Vec2::Zero());
      const double cost = costs[c].cost(x, g), turned_cost = turned_costs[c].cost(turned, h);
      EXPECT_NEAR(cost, turned_cost, 1e-9 * (1.0 + std::abs(cost))) << costs[c].name;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double scale = 1.0 + g[i].norm();
        EXPECT_NEAR(h[i].x(), -g[i].y(), 1e-9 * scale) << costs[c].name;
        EXPECT_NEAR(h[i].y(), g[i].x(), 1e-9 * scale) << costs[c].name;
      }
    }
  }
}

TEST(Costs, ClosedFormsOnARegularPolygon) {
  // a 20-gon with edges of 6 mm: each edge is 1 mm too short, each turn is 18°
  std::vector<Vec2> x, gradient(kSamples, Vec2::Zero());
  const double radius = 3.0 / std::sin(kPi / kSamples);
  for (int i = 0; i < kSamples; ++i) {
    x.push_back(radius * Vec2(std::cos(2 * kPi * i / kSamples), std::sin(2 * kPi * i / kSamples)));
  }
  EXPECT_NEAR(length_cost({x, kSamples}, 7.0, 1.0, gradient), 20.0, 1e-9);
  EXPECT_NEAR(bending_cost({x, kSamples}, 1.0, gradient),
              kSamples * std::pow(2 * kPi / kSamples, 2), 1e-9);

  // every pair except consecutive samples, each once
  std::vector<SamplePair> pairs;
  near_pairs({x, kSamples}, 1e3, pairs);
  EXPECT_EQ(pairs.size(), static_cast<std::size_t>(kSamples * (kSamples - 1) / 2 - kSamples));
  const double second = 2 * radius * std::sin(2 * kPi / kSamples);
  EXPECT_NEAR(intersection_cost({x, kSamples}, pairs, 12.5, 1.0, gradient),
              20 * std::pow(12.5 - second, 2), 1e-9);
}

TEST(Costs, AFullReversalCostsPiSquared) {
  // out and back along a line: two turns of 180°, which a plain arctan would miss
  std::vector<Vec2> x, gradient(8, Vec2::Zero());
  for (const double s : {0.0, 7.0, 14.0, 21.0, 28.0, 21.0, 14.0, 7.0}) x.push_back(Vec2(s, 0.0));
  EXPECT_NEAR(bending_cost({x, 8}, 1.0, gradient), 2 * kPi * kPi, 1e-12);
}

TEST(Costs, CoincidingSamplesGiveFiniteGradients) {
  const std::vector<Vec2> x(kSamples, Vec2(10.0, 10.0));
  std::vector<Vec2> gradient(kSamples, Vec2::Zero());
  std::vector<SamplePair> pairs;
  near_pairs({x, kSamples}, 1e3, pairs);
  length_cost({x, kSamples}, 7.0, 3.0, gradient);
  intersection_cost({x, kSamples}, pairs, 8.6, 1.0, gradient);
  bending_cost({x, kSamples}, 0.3, gradient);
  for (const Vec2& g : gradient) EXPECT_EQ(g, Vec2::Zero());
}

TEST(PressureRaster, ReproducesCellsAndQuadraticsAndIsZeroFarAway) {
  TargetField field;
  field.resize(12, 9);
  field.cell = 4e-3;
  // with numbers that are exact in 24 bits
  const auto quadratic = [](double u, double v) {
    return 1.0 + 0.25 * u + 0.125 * u * u + 0.1875 * v + 0.0625 * u * v;
  };
  for (int row = 0; row < 12; ++row) {
    for (int col = 0; col < 9; ++col) {
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] = quadratic(col, row);
    }
  }
  PressureRaster raster(field.size());
  raster.set(field, 2.0);
  EXPECT_NEAR(raster.sample(Vec2(0, 0)).value, 0.5, 1e-12);
  EXPECT_NEAR(raster.sample(Vec2(32, 44)).value, 0.5 * quadratic(8, 11), 1e-12);
  // Catmull-Rom splines are exact for quadratics
  const PressureSample inside = raster.sample(Vec2(4 * 3.3, 4 * 5.7));
  EXPECT_NEAR(inside.value, 0.5 * quadratic(3.3, 5.7), 1e-12);
  EXPECT_NEAR(inside.gradient.x(), 0.5 * (0.25 + 0.25 * 3.3 + 0.0625 * 5.7) / 4, 1e-12);
  for (const Vec2& x : {Vec2(-9, 0), Vec2(1e12, 3), Vec2(3, -1e300), Vec2(0, 53)}) {
    EXPECT_EQ(raster.sample(x).value, 0.0);
    EXPECT_EQ(raster.sample(x).gradient, Vec2::Zero());
  }
}

TEST(Refiner, NeverRaisesTheCostAndMissesNoNearPair) {
  Random random(13);
  Refiner refiner(CostSettings(PlanSettings{}), kPaths, kSamples, 60);
  PressureRaster raster(fields::kCells * fields::kCells);
  for (int trial = 0; trial < 8; ++trial) {
    const TargetField field =
        fields::make(fields::kPatterns[static_cast<std::size_t>(trial)], trial);
    raster.set(field, max_pressure(field));
    std::vector<Vec2> x = random_paths(random, true), gradient(x.size());
    const double before = refiner.evaluate(raster, x, gradient);
    const RefineResult result = refiner.run(raster, x);
    EXPECT_LT(result.cost, before);

    // the same cost from all pairs, not only from the maintained list
    Refiner fresh(CostSettings(PlanSettings{}), kPaths, kSamples, 0);
    EXPECT_EQ(result.cost, fresh.evaluate(raster, x, gradient));
  }
}

}  // namespace
}  // namespace prostm
