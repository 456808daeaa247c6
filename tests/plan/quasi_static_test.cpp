#include "prostm/plan/quasi_static/quasi_static.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plan_checks.hpp"
#include "prostm/core/random.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 8.6e-3;
constexpr GainLaw kGain{1.4};

Plan random_plan(Random& random, int paths, int points) {
  Plan plan;
  for (int k = 0; k < paths; ++k) {
    FocalPath path;
    path.patch = k % 2;
    const Vec2 centre(random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06));
    for (int i = 0; i < points; ++i) {
      path.points.push_back(centre +
                            Vec2(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03)));
      path.pressure.push_back(random.uniform());
    }
    plan.paths.push_back(path);
  }
  return plan;
}

TargetField raster_of(int rows, int cols) {
  TargetField raster;
  raster.resize(rows, cols);
  raster.cell = 4e-3;
  raster.origin = Vec2(-0.08, -0.07);
  return raster;
}

/// Computes Eq. (1) by its definition: over all segments of all paths of the patch.
double field_at(const Plan& plan, int patch, const Vec2& x) {
  double nearest = HUGE_VAL, pressure = 0.0;
  for (const FocalPath& path : plan.paths) {
    if (path.patch != patch) continue;
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      const std::size_t j = (i + 1) % path.points.size();
      const Vec2 edge = path.points[j] - path.points[i];
      const double t = std::clamp((x - path.points[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      const double distance = (path.points[i] + t * edge - x).norm();
      if (distance >= nearest) continue;
      nearest = distance;
      pressure = (1.0 - t) * path.pressure[i] + t * path.pressure[j];
    }
  }
  return pressure / kGain.gain * std::exp(-0.5 * nearest * nearest / (kSigma * kSigma));
}

// Cells from far finer than segments, which are searched tile by tile, to coarser ones.
TEST(PathSegments, FindTheSameOnARasterAsAtEachPoint) {
  Random random(22);
  for (int trial = 0; trial < 60; ++trial) {
    Plan plan = random_plan(random, 1 + random.below(8), 3 + random.below(62));
    plan.foci.push_back({0, Vec2(random.uniform(-0.05, 0.05), 0.0), 1.0});
    TargetField raster = raster_of(1 + random.below(50), 1 + random.below(50));
    raster.cell = 1e-4 * std::pow(50.0, random.uniform());
    PathSegments segments(plan, 0), alone(plan, 0);
    std::vector<int> visits(raster.size(), 0);
    segments.for_closest(raster, 0, raster.rows, [&](std::size_t cell, const ClosestPoint& found) {
      ++visits[cell];
      const auto cols = static_cast<std::size_t>(raster.cols);
      const ClosestPoint expected = alone.closest(
          raster.position(static_cast<int>(cell / cols), static_cast<int>(cell % cols)));
      EXPECT_EQ(found.segment, expected.segment);
      EXPECT_EQ(found.distance2, expected.distance2);
      EXPECT_EQ(found.along, expected.along);
      EXPECT_EQ(found.pressure, expected.pressure);
    });
    EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), std::ssize(visits));
  }
}

TEST(QuasiStaticField, AgreesWithItsDefinition) {
  Random random(21);
  for (int trial = 0; trial < 40; ++trial) {
    const Plan plan = random_plan(random, 1 + random.below(8), 3 + random.below(62));
    const TargetField raster = raster_of(1 + random.below(40), 1 + random.below(40));
    for (const int patch : {0, 1}) {
      std::vector<double> field(raster.size(), -1.0);
      quasi_static_field(plan, patch, raster, kSigma, kGain, field);
      if (static_cast<std::size_t>(patch) >= plan.paths.size()) {
        for (const double p : field) ASSERT_EQ(p, 0.0);
        continue;
      }
      for (int row = 0; row < raster.rows; ++row) {
        for (int col = 0; col < raster.cols; ++col) {
          ASSERT_NEAR(field[raster.index(row, col)],
                      field_at(plan, patch, raster.position(row, col)), 1e-12);
        }
      }
    }
  }
}

TEST(QuasiStaticField, OfEquallyNearPointsTheFirstPathIsUsed) {
  // two mirrored squares; the middle column has the same distance to both
  Plan plan;
  for (const double side : {-1.0, 1.0}) {
    FocalPath path;
    for (const Vec2& corner :
         {Vec2(0.01, -0.01), Vec2(0.01, 0.01), Vec2(0.03, 0.01), Vec2(0.03, -0.01)}) {
      path.points.push_back(Vec2(side * corner.x(), corner.y()));
      path.pressure.push_back(side < 0.0 ? 2.8 : 1.4);
    }
    plan.paths.push_back(path);
  }
  TargetField raster = raster_of(3, 3);
  raster.cell = 4e-3;
  raster.origin = Vec2(-4e-3, -4e-3);
  std::vector<double> field(raster.size());
  quasi_static_field(plan, 0, raster, kSigma, kGain, field);
  const double middle = std::exp(-0.5 * 1e-4 / (kSigma * kSigma));
  EXPECT_NEAR(field[raster.index(1, 1)], 2.0 * middle, 1e-12);
  EXPECT_GT(field[raster.index(1, 0)], field[raster.index(1, 2)]);
}

TEST(QuasiStaticField, DoesNotAllocate) {
  Random random(22);
  const Plan plan = random_plan(random, 4, 20);
  const TargetField raster = raster_of(40, 40);
  std::vector<double> field(raster.size());
  const test::HeapGuard guard;
  quasi_static_field(plan, 0, raster, kSigma, kGain, field);
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Plan, ClosedLengthIncludesTheLastSegment) {
  FocalPath path;
  for (const Vec2& x : {Vec2(0, 0), Vec2(0.03, 0), Vec2(0.03, 0.04)}) path.points.push_back(x);
  EXPECT_DOUBLE_EQ(closed_length(path), 0.12);
}

}  // namespace
}  // namespace prostm
