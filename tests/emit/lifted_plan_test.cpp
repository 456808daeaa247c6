#include "prostm/plan/lifted_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "emit/paths.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

using test::ring;

/// Returns a field of 40 × 40 cells of 5 mm, all skin, with heights f [m].
template <class F>
TargetFrame frame_with_height(F f) {
  TargetFrame frame;
  frame.time = 1.25;
  frame.patches.emplace_back();
  TargetField& field = frame.patches.back();
  field.cell = 5e-3;
  field.origin = Vec2(-0.0975, -0.0975);
  field.resize(40, 40);
  for (int row = 0; row < 40; ++row) {
    for (int col = 0; col < 40; ++col) {
      field.skin[field.index(row, col)] = 1;
      field.height[field.index(row, col)] = f(field.position(row, col));
    }
  }
  return frame;
}

/// The paper's path: 20 points, 140 mm, 7 m/s.
FocalPath circle(int points = 20, double length = 0.140) {
  FocalPath path;
  const double radius = length / points / (2.0 * std::sin(kPi / points));
  for (int i = 0; i < points; ++i) {
    const double a = 2.0 * kPi * i / points;
    path.points.emplace_back(radius * std::cos(a), radius * std::sin(a));
    path.pressure.push_back(1.0 + 0.5 * std::cos(a));
  }
  path.length = length;
  path.speed = 7.0;
  path.period = length / 7.0;
  return path;
}

TEST(Lift, AFocusGetsTheHeightOfTheSkin) {
  TargetFrame frame = frame_with_height([](const Vec2& x) { return 0.3 * x.x() - 0.1 * x.y(); });
  frame.patches[0].X_DP = Eigen::Translation3d(0.01, 0.02, 0.2) *
                          Eigen::AngleAxisd(0.4, Vec3(1.0, 2.0, 0.5).normalized());
  Plan plan;
  plan.foci.push_back({0, Vec2(0.0123, -0.0345), 2.5});
  LiftedPlan lifted;
  lifted.paths.push_back(ring(Vec3::Zero(), 0.1, 20, 1.0));  // remains of an earlier plan
  lift(plan, frame, lifted);
  EXPECT_TRUE(lifted.paths.empty());
  ASSERT_EQ(lifted.foci.size(), 1u);
  EXPECT_EQ(lifted.foci[0].pressure, 2.5);
  const Vec3 expected(0.0123, -0.0345, 0.3 * 0.0123 + 0.1 * 0.0345);
  EXPECT_LT((lifted.foci[0].p_D - frame.patches[0].X_DP * expected).norm(), 1e-12);
}

TEST(Lift, FlatSkinKeepsLengthAndPressure) {
  const TargetFrame frame = frame_with_height([](const Vec2&) { return 0.0; });
  Plan plan;
  plan.paths.push_back(circle());
  LiftedPlan lifted;
  lifted.id = 17;
  lift(plan, frame, lifted);
  ASSERT_EQ(lifted.paths.size(), 1u);
  EXPECT_EQ(lifted.id, 17);
  const LiftedPath& path = lifted.paths[0];
  ASSERT_EQ(path.p_D.size(), 100u);
  EXPECT_NEAR(path.length, 0.140, 1e-12);
  EXPECT_DOUBLE_EQ(path.speed, 7.0);
  for (std::size_t i = 0; i < path.p_D.size(); ++i) {
    EXPECT_NEAR(path.p_D[i].z(), 0.2, 1e-12);
    EXPECT_NEAR(path.s[i], 0.0014 * static_cast<double>(i), 1e-12);
  }
  const FocalPath& flat = plan.paths[0];
  EXPECT_NEAR(path.pressure[5], flat.pressure[1], 1e-12);
  EXPECT_NEAR(path.pressure[7], 0.6 * flat.pressure[1] + 0.4 * flat.pressure[2], 1e-12);
  EXPECT_NEAR(path.pressure[98], 0.4 * flat.pressure[19] + 0.6 * flat.pressure[0], 1e-12);
}

TEST(Lift, ASlopeLengthensThePath) {
  // a 30° slope up and down: a path across it keeps its length, a path along it grows by 1/cos 30°
  const double slope = std::tan(kPi / 6.0);
  const TargetFrame frame = frame_with_height([&](const Vec2& x) { return slope * x.x(); });
  Plan plan;
  for (const Vec2& end : {Vec2(0.07, 0.0), Vec2(0.0, 0.07)}) {
    FocalPath path;
    path.speed = 7.0;
    for (const double t : {-0.5, 0.5}) {
      path.points.push_back(t * end);
      path.pressure.push_back(1.0);
    }
    plan.paths.push_back(path);
  }
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  // smoothing rounds the two turns, over two cells each
  EXPECT_NEAR(lifted.paths[0].length, 0.140 / std::cos(kPi / 6.0), 0.004);
  EXPECT_GT(lifted.paths[0].length, 0.150);
  EXPECT_NEAR(lifted.paths[1].length, 0.140, 1e-9);
  // the plane's pose applies: the default plane is 200 mm above the array
  double highest = 0.0;
  for (const Vec3& p : lifted.paths[0].p_D) highest = std::max(highest, p.z());
  EXPECT_NEAR(highest, 0.2 + 0.035 * slope, 0.003);
}

TEST(Lift, TheSteppedSkinOfARasterDoesNotLengthenThePath) {
  // a 20° slope in voxels of 5 mm is stepped
  const double slope = std::tan(20.0 * kPi / 180.0);
  const auto smooth = frame_with_height([&](const Vec2& x) { return slope * x.x(); });
  const auto stairs = frame_with_height(
      [&](const Vec2& x) { return 5e-3 * std::floor(slope * x.x() / 5e-3 + 0.5); });
  Plan plan;
  plan.paths.push_back(circle());
  LiftedPlan a, b;
  lift(plan, smooth, a);
  lift(plan, stairs, b);
  EXPECT_GT(a.paths[0].length, 0.141);
  EXPECT_NEAR(b.paths[0].length, a.paths[0].length, 0.015 * a.paths[0].length);
  // the same path without smoothing of the steps
  LiftedPath raw = b.paths[0];
  for (Vec3& p : raw.p_D) p.z() = height_at(stairs.patches[0], p.head<2>());
  measure(raw);
  EXPECT_GT(raw.length, 1.03 * a.paths[0].length);
}

/// Holds even if the kernel of (E1) is as wide as the path: the opposite point of a circle is
/// equally close in both directions.
TEST(Lift, LengthDoesNotDependOnTheFirstPoint) {
  Random random(1);
  for (const double length : {0.010, 0.019, 0.021, 0.040, 0.140}) {
    for (int draw = 0; draw < 200; ++draw) {
      const TargetFrame frame =
          frame_with_height([&](const Vec2&) { return 0.01 * random.uniform(); });
      Plan plan;
      plan.paths.push_back(circle(20, length));
      const Vec2 centre(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
      for (Vec2& x : plan.paths[0].points) x += centre;
      plan.paths.push_back(plan.paths[0]);
      std::vector<Vec2> later(plan.paths[0].points.begin(), plan.paths[0].points.end());
      std::rotate(later.begin(), later.begin() + 1 + random.below(19), later.end());
      if (random.below(2) == 0) std::reverse(later.begin(), later.end());
      std::copy(later.begin(), later.end(), plan.paths[1].points.begin());
      LiftedPlan lifted;
      lift(plan, frame, lifted);
      ASSERT_NEAR(lifted.paths[1].length, lifted.paths[0].length, 1e-9 * lifted.paths[0].length)
          << length << ", draw " << draw;
    }
  }
}

TEST(Lift, DegeneratePathsAreAtRest) {
  const TargetFrame frame = frame_with_height([](const Vec2& x) { return 0.1 * x.y(); });
  Plan plan;
  FocalPath path;
  path.speed = 7.0;
  plan.paths.push_back(path);  // omitted, since it has no points
  path.points.emplace_back(0.01, 0.02);
  path.pressure.push_back(3.0);
  plan.paths.push_back(path);
  for (int i = 0; i < 6; ++i) {
    path.points.push_back(path.points[0]);
    path.pressure.push_back(3.0);
  }
  plan.paths.push_back(path);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  ASSERT_EQ(lifted.paths.size(), 2u);
  for (const LiftedPath& rest : lifted.paths) {
    ASSERT_EQ(rest.p_D.size(), 1u);
    EXPECT_EQ(rest.length, 0.0);
    EXPECT_LT((rest.p_D[0] - Vec3(0.01, 0.02, 0.202)).norm(), 1e-9);
    EXPECT_LT((point_at(rest, 123.0).p_D - rest.p_D[0]).norm(), 1e-15);
    EXPECT_EQ(point_at(rest, -1.0).pressure, 3.0);
  }
}

TEST(Lift, AcceptsAnyPathWithoutAllocation) {
  const TargetFrame frame = frame_with_height([](const Vec2& x) { return 30.0 * x.squaredNorm(); });
  Random random(11);
  LiftedPlan lifted;
  for (int round = 0; round < 300; ++round) {
    Plan plan;
    const int paths = random.below(kMaxPaths + 1);
    for (int p = 0; p < paths; ++p) {
      FocalPath path;
      path.speed = random.uniform(0.0, 8.0);
      const double size = std::pow(10.0, random.uniform(-9.0, 0.0));
      const int points = random.below(kMaxPathPoints + 1);
      for (int i = 0; i < points; ++i) {
        path.points.emplace_back(size * random.normal(), size * random.normal());
        path.pressure.push_back(random.uniform());
      }
      plan.paths.push_back(path);
    }
    const test::HeapGuard guard;
    lift(plan, frame, lifted);
    EXPECT_EQ(guard.allocations(), 0u);
    for (const LiftedPath& path : lifted.paths) {
      ASSERT_EQ(path.s.size(), path.p_D.size());
      ASSERT_EQ(path.pressure.size(), path.p_D.size());
      EXPECT_TRUE(std::isfinite(path.length));
      EXPECT_EQ(path.s[0], 0.0);
      for (std::size_t i = 1; i < path.s.size(); ++i) EXPECT_GE(path.s[i], path.s[i - 1]);
    }
  }
}

TEST(PointAt, FollowsThePolygonAtUnitSpeed) {
  const LiftedPath path = ring(Vec3(0.0, 0.0, 0.2), 0.140, 20, 1.0);
  for (int i = 0; i < 800; ++i) {
    const double s = 0.140 * i / 800.0;
    const PathPoint a = point_at(path, s), b = point_at(path, s + 0.175e-3);
    EXPECT_LE((b.p_D - a.p_D).norm(), 0.175e-3 + 1e-12);
    EXPECT_LT((point_at(path, s - 3 * path.length).p_D - a.p_D).norm(), 1e-12);
    // all points lie on the polygon
    EXPECT_LT(nearest_place(path, a.p_D).distance, 1e-12);
    EXPECT_NEAR(std::remainder(nearest_place(path, a.p_D).s - s, path.length), 0.0, 1e-12);
  }
}

TEST(NearestPlace, IsNoFartherThanADenseSearch) {
  Random random(23);
  const LiftedPath path = ring(Vec3(0.0, 0.0, 0.2), 0.140, 100, 1.0);
  for (int round = 0; round < 200; ++round) {
    const Vec3 p(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                 random.uniform(0.18, 0.22));
    double dense = 1.0;
    for (int i = 0; i < 4000; ++i) {
      dense = std::min(dense, (point_at(path, 0.140 * i / 4000.0).p_D - p).norm());
    }
    const PathPlace place = nearest_place(path, p);
    EXPECT_LE(place.distance, dense + 1e-12);
    EXPECT_NEAR((place.p_D - p).norm(), place.distance, 1e-12);
    EXPECT_LT((point_at(path, place.s).p_D - place.p_D).norm(), 1e-12);
    EXPECT_NEAR(place.tangent.norm(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace prostm
