/// Counts and measurements of the planner's lab, for plans with known answers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/am.hpp"
#include "planner/bending.hpp"
#include "planner/contenders.hpp"
#include "planner/power.hpp"
#include "planner/sequences.hpp"
#include "planner/simultaneous.hpp"
#include "planner/steadiness.hpp"
#include "planner/violations.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/core/units.hpp"
#include "prostm/io/field/field_file.hpp"
#include "support/input_errors.hpp"

namespace prostm::bench {
namespace {

constexpr double kSigma = 8.6e-3, kMaxLength = 0.14;

/// Returns a regular polygon that starts at corner `first`, in the other direction if `reversed`.
FocalPath polygon(const Vec2& centre, double length, int first = 0, bool reversed = false) {
  constexpr int kCorners = 20;
  const double radius = length / (2.0 * kCorners * std::sin(kPi / kCorners));
  FocalPath path;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * kPi * (reversed ? first - i : first + i) / kCorners;
    path.points.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    path.pressure.push_back(1.0);
  }
  path.length = closed_length(path);
  return path;
}

Plan plan_of(const std::vector<FocalPath>& paths) {
  Plan plan;
  for (const FocalPath& path : paths) plan.paths.push_back(path);
  return plan;
}

Violations violations_of(const Plan& plan) {
  Violations v;
  v.add(plan, kSigma, kMaxLength);
  return v;
}

TEST(Am, TheErrorDecreasesWithTheNumberOfFociAndForFewWithSigma) {
  std::vector<Row> rows;
  const std::vector<Sequence> sequences = gallery();
  measure_am_table(sequences, 2, rows);
  ASSERT_EQ(rows.size(), sequences.size() * 3 * 4);
  // [N][σ], summed over the sequences
  double rmse[3][4] = {};
  for (std::size_t i = 0; i < rows.size(); ++i) rmse[i / 4 % 3][i % 4] += rows[i].ours.p50;
  for (const int sigma : {0, 1, 2, 3}) {
    EXPECT_LT(rmse[1][sigma], rmse[0][sigma]);
    EXPECT_LT(rmse[2][sigma], rmse[1][sigma]);
  }
  for (const int foci : {0, 1}) EXPECT_LT(rmse[foci][1], rmse[foci][0]);
  EXPECT_EQ(rows[0].baseline_p50, 0.335);  // [B-1], no emitter
}

TEST(Am, IsComparedWithThePapersTime) {
  std::vector<Row> rows;
  measure_am({gallery().front()}, 2, rows);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].unit, "us");
  EXPECT_EQ(rows[0].ours.n, 10u);
  EXPECT_EQ(rows[0].baseline_p50, 4000.0);
  EXPECT_GT(rows[0].ours.p50, 1.0);
}

TEST(Motion, ARigidlyMovedPlanMovesByItsDisplacement) {
  const Plan before = plan_of({polygon(Vec2(0.0, 0.0), 0.14), polygon(Vec2(0.06, 0.0), 0.10)});
  EXPECT_EQ(motion(before, before), 0.0);
  // the paths in another order, with other first points, one in the other direction
  const Vec2 d(1e-3, -2e-3);
  const Plan after = plan_of({polygon(Vec2(0.06, 0.0) + d, 0.10, 4, true), polygon(d, 0.14, 12)});
  EXPECT_NEAR(motion(before, after), d.norm(), 1e-9);
}

TEST(Motion, AnUnmatchedPathCountsItsDistanceToTheNearestOne) {
  const FocalPath inner = polygon(Vec2::Zero(), 0.10), outer = polygon(Vec2::Zero(), 0.14);
  // the circles' radii differ by 40 mm / 2π; the outer circle is unchanged
  const double gap = 0.04 / (2.0 * kPi);
  EXPECT_NEAR(motion(plan_of({outer}), plan_of({inner, outer})), 0.5 * gap, 0.02 * gap);
  EXPECT_NEAR(motion(plan_of({inner, outer}), plan_of({outer})), 0.5 * gap, 0.02 * gap);
}

TEST(Violations, AGoodPlanHasNone) {
  const Violations v =
      violations_of(plan_of({polygon(Vec2::Zero(), 0.14), polygon(Vec2(0.06, 0.0), 0.14)}));
  EXPECT_EQ(v.plans, 1);
  EXPECT_EQ(v.long_paths + v.crossings + v.near_plans + v.near_pairs + v.non_finite, 0);
}

TEST(Violations, EachKindIsCounted) {
  EXPECT_EQ(violations_of(plan_of({polygon(Vec2::Zero(), 0.1404)})).long_paths, 0);
  EXPECT_EQ(violations_of(plan_of({polygon(Vec2::Zero(), 0.1406)})).long_paths, 1);

  // two overlapping circles cross twice
  const Violations crossed =
      violations_of(plan_of({polygon(Vec2::Zero(), 0.14), polygon(Vec2(0.0301, 0.0), 0.14)}));
  EXPECT_EQ(crossed.crossings, 2);
  EXPECT_EQ(crossed.near_plans, 1);

  // two swapped points make a figure of eight
  FocalPath eight = polygon(Vec2::Zero(), 0.14);
  std::swap(eight.points[4], eight.points[5]);
  eight.length = closed_length(eight);
  EXPECT_GT(violations_of(plan_of({eight})).crossings, 0);

  // concentric circles 0.85 σ apart: every sample has a neighbour on the other circle
  const double apart = 0.85 * kSigma;
  const Violations near = violations_of(
      plan_of({polygon(Vec2::Zero(), 0.14), polygon(Vec2::Zero(), 0.14 - 2.0 * kPi * apart)}));
  EXPECT_EQ(near.near_plans, 1);
  EXPECT_GE(near.near_pairs, 20);

  // neighbours along a path may be close, opposite sides of a narrow loop may not
  EXPECT_EQ(violations_of(plan_of({polygon(Vec2::Zero(), 0.05)})).near_pairs, 0);
  FocalPath narrow = polygon(Vec2::Zero(), 0.14);
  for (Vec2& x : narrow.points) x.y() *= 0.1;
  narrow.length = closed_length(narrow);
  EXPECT_GT(violations_of(plan_of({narrow})).near_pairs, 0);

  FocalPath broken = polygon(Vec2::Zero(), 0.14);
  broken.pressure[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(violations_of(plan_of({broken})).non_finite, 1);
}

TEST(LeastDistances, AreThoseOfTheClosestActivePair) {
  LeastDistances d;
  d.add(std::vector<Vec3>{Vec3::Zero()});
  EXPECT_EQ(d.instants(), 0u);
  EXPECT_EQ(d.least(), 0.0);
  for (int i = 1; i <= 20; ++i) {
    d.add(std::vector<Vec3>{Vec3::Zero(), Vec3(1.0, 0, 0), Vec3(1.0, 1e-3 * i, 0)});
  }
  EXPECT_EQ(d.instants(), 20u);
  EXPECT_DOUBLE_EQ(d.least(), 1e-3);
  EXPECT_DOUBLE_EQ(d.quantile(0.05), 1e-3);
  EXPECT_DOUBLE_EQ(d.quantile(0.5), 10e-3);
  EXPECT_DOUBLE_EQ(d.share_below(5.5e-3), 0.25);
}

TEST(Simultaneous, FocalPointsFollowTheirOwnPeriods) {
  // two circles of equal length from the same angle keep the distance of their centres; in
  // opposite directions the points meet where the circles are closest
  const auto follow_two = [](FocalPath a, FocalPath b, double b_period) {
    a.period = 0.02;
    b.period = b_period;
    LeastDistances d;
    follow(plan_of({a, b}), 0.2, 0.5, d);
    return d;
  };
  const FocalPath a = polygon(Vec2::Zero(), 0.14), b = polygon(Vec2(0.06, 0.0), 0.14);
  const LeastDistances same = follow_two(a, b, 0.02);
  EXPECT_EQ(same.instants(), 1600u);
  EXPECT_NEAR(same.least(), 0.06, 1e-9);
  EXPECT_NEAR(same.quantile(1.0), 0.06, 1e-9);
  const double radius = 0.14 / (40.0 * std::sin(kPi / 20.0));
  const LeastDistances opposite = follow_two(a, begun_at(b, 10, true), 0.02);
  EXPECT_NEAR(opposite.least(), 0.06 - 2.0 * radius, 1e-4);
  EXPECT_NEAR(follow_two(a, begun_at(b, 10, false), 0.02).least(), 0.06 - 2.0 * radius, 1e-4);
  // with different periods the phases drift through all values
  EXPECT_NEAR(follow_two(a, b, 0.019).least(), 0.06 - 2.0 * radius, 2e-3);

  // silent focal points do not count
  FocalPath silent = b;
  silent.pressure.assign(silent.pressure.size(), 0.4);
  EXPECT_EQ(follow_two(a, silent, 0.02).instants(), 0u);
}

TEST(Simultaneous, RandomStartsKeepThePaths) {
  const FocalPath path = polygon(Vec2(0.01, 0.02), 0.12);
  const FocalPath back = begun_at(path, 7, true);
  EXPECT_EQ(back.points[0], path.points[7]);
  EXPECT_EQ(back.points[1], path.points[6]);
  EXPECT_EQ(back.points[19], path.points[8]);
  Random random(1);
  for (int draw = 0; draw < 100; ++draw) {
    EXPECT_LT(motion(plan_of({path}), begun_anywhere(plan_of({path}), random, true)), 1e-12);
  }
}

TEST(Sequences, FramesAreEvenlySpaced) {
  EXPECT_EQ(spread(100, 4), (std::vector<int>{12, 37, 62, 87}));
  EXPECT_EQ(spread(3, 20), (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(spread(100, 1), std::vector<int>{50});
}

TEST(Sequences, AFieldFileIsASequenceOfOneFrame) {
  const test::TemporaryFolder folder;
  TargetField target;
  target.resize(3, 4);
  target.cell = 2e-3;
  target.skin.assign(target.size(), 1);
  const auto write = [&] { write_file(folder.file("mine.json"), field_to_json(target)); };
  write();
  EXPECT_THAT(test::input_error([&] { read_sequence(folder.file("mine.json")); }),
              testing::HasSubstr("no"));
  target.pressure[5] = 7.0;
  write();
  const Sequence sequence = read_sequence(folder.file("mine.json"));
  EXPECT_EQ(sequence.name, "mine");
  EXPECT_EQ(sequence.frames, 1);
  EXPECT_EQ(sequence.cells, 12u);
  EXPECT_EQ(sequence.field(0).pressure, target.pressure);
  test::input_error([&] { read_sequence(folder.file("absent.h5")); });
}

TEST(Contenders, OnlyAWarmOneContinues) {
  TargetField field;
  field.resize(24, 24);
  field.cell = 4e-3;
  for (int row = 4; row < 20; ++row) {
    for (int col = 4; col < 20; ++col) {
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] = 0.1 + 0.01 * row * ((col * row) % 7);
    }
  }
  const auto is_repeated = [&](bool warm) {
    Contender contender({"fast", "fast", 0.0, warm});
    contender.begin(field.size());
    Plan first, second;
    PlanStats stats;
    EXPECT_EQ(contender.plan(field, first, stats), PlanStatus::Planned);
    EXPECT_EQ(contender.plan(field, second, stats), PlanStatus::Planned);
    return first.paths[0].points == second.paths[0].points;
  };
  EXPECT_TRUE(is_repeated(false));
  EXPECT_FALSE(is_repeated(true));
}

FocalPath through(const std::vector<Vec2>& points) {
  FocalPath path;
  path.points.assign(points.begin(), points.end());
  return path;
}

TEST(Bending, MatchesShapesWithKnownTurns) {
  // convex: 2π in total, in equal parts
  const Bending round = bending(polygon(Vec2::Zero(), 0.14));
  EXPECT_NEAR(round.sharpest, 2.0 * kPi / 20, 1e-9);
  EXPECT_NEAR(round.rms, 2.0 * kPi / 20, 1e-9);
  EXPECT_NEAR(round.excess, 0.0, 1e-9);
  // in either direction an L has five corners to one side and one to the other, of 90°
  std::vector<Vec2> corners{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (int way = 0; way < 2; ++way) {
    const Bending angular = bending(through(corners));
    EXPECT_NEAR(angular.sharpest, 0.5 * kPi, 1e-9);
    EXPECT_NEAR(angular.rms, 0.5 * kPi, 1e-9);
    EXPECT_NEAR(angular.excess, kPi, 1e-9);
    std::reverse(corners.begin(), corners.end());
  }
  // out and back, with a straight point in the middle
  const Bending flat = bending(through({{0, 0}, {1, 0}, {2, 0}, {1, 1e-9}}));
  EXPECT_NEAR(flat.sharpest, kPi, 1e-6);
  EXPECT_NEAR(flat.rms, std::sqrt(0.5) * kPi, 1e-6);
}

TEST(Power, OneFocalPointGetsTheRequestedPressure) {
  const std::vector<FocusSample> one = {{Eigen::Vector3f(0.02F, -0.01F, 0.2F), 0.5F}};
  EXPECT_NEAR(reached(usx_array(), FocusMethod::Weighted, one)[0], 0.25, 1e-9);
  EXPECT_NEAR(reached(usx_array(), FocusMethod::Superposition, one)[0], 0.25, 1e-9);
}

TEST(Power, SeveralShareTheArray) {
  // far from each other, where the drives for one focal point hardly contribute at another
  for (int foci = 2; foci <= 8; ++foci) {
    std::vector<FocusSample> all;
    for (int f = 0; f < foci; ++f) {
      const double angle = 2.0 * kPi * f / foci + 0.3;
      all.push_back(
          {(Vec3(0.045 * std::cos(angle), 0.045 * std::sin(angle), 0.2)).cast<float>(), 1.0F});
    }
    const auto mean = [&](FocusMethod method) {
      double sum = 0.0;
      for (const double p : reached(usx_array(), method, all)) sum += p / foci;
      return sum;
    };
    // at most 1/P of the power each; superposed, about 1/P² of the pressure
    const double full = mean(FocusMethod::Weighted);
    EXPECT_LT(full, 1.1 / foci) << foci;
    EXPECT_GT(full, 0.6 / foci) << foci;
    EXPECT_LT(mean(FocusMethod::Superposition), full) << foci;
    EXPECT_NEAR(mean(FocusMethod::Superposition) * foci * foci, 1.0, 0.6) << foci;
  }
}

}  // namespace
}  // namespace prostm::bench
