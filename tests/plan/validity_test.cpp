#include "prostm/plan/detail/validity.hpp"

#include <gtest/gtest.h>

#include "plan_checks.hpp"
#include "prostm/core/random.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using namespace planning;

constexpr double kLength = 140.0;

/// Returns the samples as a plan, for the independent checks.
Plan as_plan(std::span<const Vec2> x, int samples) {
  Plan plan;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % static_cast<std::size_t>(samples) == 0) plan.paths.emplace_back();
    FocalPath& path = plan.paths.back();
    path.points.push_back(1e-3 * x[i]);
    path.pressure.push_back(0.0);
  }
  for (FocalPath& path : plan.paths) {
    path.length = closed_length(path);
    path.speed = 7.0;
    path.period = path.length / path.speed;
  }
  return plan;
}

std::vector<Vec2> circle(const Vec2& centre, double radius, int samples) {
  std::vector<Vec2> x;
  for (int i = 0; i < samples; ++i) {
    const double angle = 2.0 * kPi * i / samples;
    x.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
  }
  return x;
}

TEST(MakeValid, LeavesValidPathsUnchanged) {
  std::vector<Vec2> x = circle({0, 0}, 20, 20);
  const std::vector<Vec2> second = circle({50, 0}, 20, 20);
  x.insert(x.end(), second.begin(), second.end());
  const std::vector<Vec2> before = x;
  EXPECT_EQ(make_valid(x, 20, kLength), 2);
  EXPECT_EQ(x, before);
}

TEST(MakeValid, UntanglesAFigureOfEightWithoutMovingItsPoints) {
  std::vector<Vec2> x;
  for (int i = 0; i < 20; ++i) {
    const double t = 2.0 * kPi * (i + 0.3) / 20;
    x.push_back(Vec2(20.0 * std::sin(t), 8.0 * std::sin(2.0 * t)));
  }
  EXPECT_GT(count_self_crossings(x), 0);
  EXPECT_FALSE(is_simple(x));
  std::vector<Vec2> before = x;
  EXPECT_EQ(make_valid(x, 20, kLength), 1);
  EXPECT_TRUE(is_simple(x));
  const auto less = [](const Vec2& a, const Vec2& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  };
  std::sort(before.begin(), before.end(), less);
  std::sort(x.begin(), x.end(), less);
  EXPECT_EQ(x, before);
}

TEST(MakeValid, ScalesALongPathAboutItsCentroid) {
  std::vector<Vec2> x = circle({30, 5}, 30, 20);
  EXPECT_EQ(make_valid(x, 20, kLength), 1);
  EXPECT_NEAR(loop_length(x), kLength, 1e-9);
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : x) mean += p / 20.0;
  EXPECT_LT((mean - Vec2(30, 5)).norm(), 1e-9);
}

TEST(MakeValid, PushesACrossingPathOffTheHeavierOne) {
  std::vector<Vec2> x = circle({0, 0}, 20, 20);
  const std::vector<Vec2> heavier = x, second = circle({36, 0}, 20, 20);
  x.insert(x.end(), second.begin(), second.end());
  EXPECT_EQ(make_valid(x, 20, kLength), 2);
  EXPECT_TRUE(std::equal(heavier.begin(), heavier.end(), x.begin()));
  EXPECT_NEAR(loop_length(std::span<const Vec2>(x).subspan(20)), loop_length(second), 1e-9);
  EXPECT_EQ(test::touching_pairs(as_plan(x, 20)), 0);
}

TEST(MakeValid, ShrinksOrDropsPathsThatCoverEachOther) {
  // the same circle eight times: the circles shrink inside each other, down to the smallest length
  std::vector<Vec2> x;
  for (int k = 0; k < 8; ++k) {
    const std::vector<Vec2> one = circle({1e-4 * k, 0}, 22, 20);
    x.insert(x.end(), one.begin(), one.end());
  }
  const int kept = make_valid(x, 20, kLength);
  EXPECT_GE(kept, 2);
  x.resize(static_cast<std::size_t>(kept) * 20);
  test::expect_valid_plan(as_plan(x, 20), 20, 1e-3 * kLength);
}

TEST(MakeValid, MakesAnythingValid) {
  Random random(41);
  const std::uint64_t count = test::reduced(4000);
  for (std::uint64_t trial = 0; trial < count; ++trial) {
    SCOPED_TRACE("trial " + std::to_string(trial));
    // random points, collinear points, points on a coarse lattice (many coincide), equal points
    const int samples = 8 + random.below(kMaxPathPoints - 7), paths = 1 + random.below(kMaxPaths);
    const int kind = random.below(4);
    const double spread = std::pow(10.0, random.uniform(-4.0, 2.5));
    std::vector<Vec2> x;
    for (int i = 0; i < samples * paths; ++i) {
      const Vec2 u(random.uniform(), random.uniform());
      if (kind == 0) x.push_back(spread * u);
      if (kind == 1) x.push_back(spread * u.x() * Vec2(1.0, 2.0));
      if (kind == 2) x.push_back(spread * Vec2(std::floor(5 * u.x()), std::floor(5 * u.y())));
      if (kind == 3) x.push_back(Vec2(3.0, 4.0));
    }
    const int kept = make_valid(x, samples, kLength);
    ASSERT_GE(kept, 1);
    ASSERT_LE(kept, paths);
    x.resize(static_cast<std::size_t>(kept * samples));
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(as_plan(x, samples), samples, 1e-3 * kLength));
  }
}

TEST(SegmentsCross, ClosedForms) {
  const Vec2 o(0, 0), e(10, 0);
  EXPECT_TRUE(segments_cross(o, e, {5, -1}, {5, 1}));
  EXPECT_TRUE(segments_cross(o, e, {5, 0}, {5, 3}));       // touches
  EXPECT_TRUE(segments_cross(o, e, {4, 0}, {20, 0}));      // overlaps
  EXPECT_TRUE(segments_cross(o, e, {5, 0.5e-3}, {5, 3}));  // within the clearance
  EXPECT_FALSE(segments_cross(o, e, {5, 2e-3}, {5, 3}));
  EXPECT_FALSE(segments_cross(o, e, {10.1, -1}, {10.1, 1}));
  EXPECT_FALSE(segments_cross(o, e, {11, 0}, {20, 0}));
}

}  // namespace
}  // namespace prostm
