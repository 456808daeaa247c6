#include "prostm/score/score.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "prostm/am/am_planner.hpp"
#include "prostm/core/random.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 8.6e-3;
constexpr GainLaw kGain{1.4};

/// Returns two rows of three cells, the last one without skin.
TargetField small_target() {
  TargetField target;
  target.resize(2, 3);
  target.cell = 0.1;  // far wider than the blur, so that blurring changes nothing
  target.skin = {1, 1, 1, 1, 1, 0};
  target.pressure = {4.0, 2.0, 0.0, 2.0, 0.0, 0.0};
  return target;
}

TEST(ScoreField, ClosedFormsOnFiveCells) {
  const TargetField target = small_target();
  // pressure rendered off the skin is ignored
  const std::vector<double> rendered{2.0, 2.0, 2.0, 0.0, 0.0, 100.0};
  const Metrics m = score_field(target, rendered, 0.25);
  EXPECT_DOUBLE_EQ(m.coverage, 0.25);
  // divided by the maximum of 4: target 1 .5 0 .5 0, rendered .5 .5 .5 0 0
  EXPECT_NEAR(m.rmse, std::sqrt((0.25 + 0.0 + 0.25 + 0.25 + 0.0) / 5.0), 1e-12);
  // deviations of the target .6 .1 −.4 .1 −.4, of the rendered .2 .2 .2 −.3 −.3
  const double product = 0.12 + 0.02 - 0.08 - 0.03 + 0.12,
               spread = 0.36 + 0.01 + 0.16 + 0.01 + 0.16;
  EXPECT_NEAR(m.correlation, product / std::sqrt(spread * (3 * 0.04 + 2 * 0.09)), 1e-12);
  // g = Σ p* p̂ / Σ p̂² = .75 / .75 = 1
  EXPECT_NEAR(m.skill_0, 1.0 - 0.75 / spread, 1e-12);
  EXPECT_NEAR(m.skill_8, m.skill_0, 1e-12);
  EXPECT_NEAR(m.overlap, (0.5 + 0.5) / (1.0 + 0.5 + 0.5 + 0.5), 1e-12);
  EXPECT_NEAR(m.spill, 0.5 / 1.5, 1e-12);
}

TEST(ScoreField, APerfectFieldOfAnyStrengthHasFullSkill) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    const TargetField target = fields::make(pattern, 0);
    std::vector<double> rendered = target.pressure;
    EXPECT_NEAR(score_field(target, rendered, 1.0).rmse, 0.0, 1e-12);
    for (double& p : rendered) p *= 0.3;
    const Metrics m = score_field(target, rendered, 1.0);
    EXPECT_GT(m.rmse, 0.05);
    EXPECT_NEAR(m.correlation, 1.0, 1e-9);
    EXPECT_NEAR(m.skill_0, 1.0, 1e-9);
    EXPECT_NEAR(m.skill_8, 1.0, 1e-9);
    EXPECT_NEAR(m.overlap, 1.0, 1e-9);
  }
}

TEST(ScorePlan, OfFociUsesTheNearestFocus) {
  TargetField target = small_target();
  Plan plan;
  plan.foci.push_back({0, target.position(0, 0), 4.0});
  plan.foci.push_back({0, target.position(1, 1), 2.0});
  plan.foci.push_back({1, target.position(0, 1), 9.0});  // on another hand
  const double sigma = 0.1;                              // the edge of a cell
  const double near = std::exp(-0.5);
  const std::vector<double> rendered{4.0, 4.0 * near, 2.0 * near * near, 4.0 * near, 2.0, 0.0};
  const Metrics expected = score_field(target, rendered, 0.0);
  // two cells have the same distance to both foci: the first focus is used
  const Metrics m = score_plan(target, plan, 0, sigma, kGain);
  EXPECT_NEAR(m.rmse, expected.rmse, 1e-12);
  EXPECT_NEAR(m.correlation, expected.correlation, 1e-12);
  EXPECT_NEAR(m.coverage, 1.0, 1e-12);
}

TEST(ScoreField, AFlatFieldHasNoSkillAndNoCorrelation) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    const TargetField target = fields::make(pattern, 1);
    const Metrics m = score_field(target, std::vector<double>(target.size(), 0.7), 0.0);
    EXPECT_NEAR(m.skill_0, 0.0, 1e-9);
    EXPECT_NEAR(m.skill_8, 0.0, 1e-9);
    EXPECT_NEAR(m.correlation, 0.0, 1e-9);
  }
}

TEST(ScoreField, TheUnitOfPressureDoesNotMatter) {
  const TargetField target = fields::make(fields::Pattern::FourPlumes, 2);
  const std::vector<double> rendered = fields::make(fields::Pattern::FourPlumes, 3).pressure;
  const Metrics m = score_field(target, rendered, 0.5);
  for (const double scale : {1e-290, 1e-3, 1e290}) {
    TargetField scaled = target;
    std::vector<double> scaled_rendered = rendered;
    for (double& p : scaled.pressure) p *= scale;
    for (double& p : scaled_rendered) p *= scale;
    const Metrics n = score_field(scaled, scaled_rendered, 0.5);
    EXPECT_NEAR(n.rmse, m.rmse, 1e-9);
    EXPECT_NEAR(n.skill_8, m.skill_8, 1e-9);
    EXPECT_NEAR(n.overlap, m.overlap, 1e-9);
    EXPECT_NEAR(n.spill, m.spill, 1e-9);
  }
}

/// Computes the skill after the blur by its definition: over all pairs of skin cells.
double slow_blurred_skill(const TargetField& target, const std::vector<double>& rendered) {
  constexpr double kBlur = 8.5e-3;
  std::vector<double> a, b;
  for (int r = 0; r < target.rows; ++r) {
    for (int c = 0; c < target.cols; ++c) {
      if (target.skin[target.index(r, c)] == 0) continue;
      double weight = 0, sum_a = 0, sum_b = 0;
      for (int s = 0; s < target.rows; ++s) {
        for (int d = 0; d < target.cols; ++d) {
          const std::size_t i = target.index(s, d);
          if (target.skin[i] == 0) continue;
          const double w =
              std::exp(-0.5 * (target.position(r, c) - target.position(s, d)).squaredNorm() /
                       (kBlur * kBlur));
          weight += w;
          sum_a += w * target.pressure[i];
          sum_b += w * rendered[i];
        }
      }
      a.push_back(sum_a / weight);
      b.push_back(sum_b / weight);
    }
  }
  double ab = 0, bb = 0, mean = 0, rest = 0, spread = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += a[i] * b[i];
    bb += b[i] * b[i];
    mean += a[i] / static_cast<double>(a.size());
  }
  for (std::size_t i = 0; i < a.size(); ++i) {
    rest += std::pow(a[i] - ab / bb * b[i], 2);
    spread += std::pow(a[i] - mean, 2);
  }
  return 1.0 - rest / spread;
}

TEST(ScoreField, BlurredSkillAgreesWithItsDefinition) {
  Random random(51);
  for (int trial = 0; trial < 5; ++trial) {
    TargetField target;
    target.resize(14 + trial, 19 - trial);
    target.cell = 5e-3;
    std::vector<double> rendered(target.size());
    for (std::size_t i = 0; i < target.size(); ++i) {
      target.skin[i] = random.uniform() < 0.7 ? 1 : 0;
      target.pressure[i] = target.skin[i] != 0 ? random.uniform() : 0.0;
      rendered[i] = 0.5 * target.pressure[i] + random.uniform();
    }
    // the blur is cut off at 4 b, where the Gaussian is 3e-4
    EXPECT_NEAR(score_field(target, rendered, 0.0).skill_8, slow_blurred_skill(target, rendered),
                2e-3);
  }
}

TEST(ScorePlan, CoverageIsTheFractionWithinSigmaOfAPath) {
  TargetField target;
  target.resize(1, 11);
  target.cell = 4e-3;
  for (std::size_t i = 0; i < 11; ++i) {
    target.skin[i] = 1;
    target.pressure[i] = static_cast<double>(i + 1);
  }
  // a thin triangle that crosses the row at x = 8 mm: cells at 0 to 16 mm are within 8.6 mm
  FocalPath path;
  for (const Vec2& x : {Vec2(8e-3, -0.05), Vec2(8e-3, 0.05), Vec2(7.9e-3, 0.05)}) {
    path.points.push_back(x);
    path.pressure.push_back(1.0);
  }
  Plan plan;
  plan.paths.push_back(path);
  EXPECT_NEAR(score_plan(target, plan, 0, kSigma, kGain).coverage, 15.0 / 66.0, 1e-12);
  EXPECT_EQ(score_plan(target, plan, 1, kSigma, kGain).coverage, 0.0);
  EXPECT_EQ(score_plan(target, Plan{}, 0, kSigma, kGain).skill_0,
            score_field(target, std::vector<double>(11), 0).skill_0);
}

TEST(ScorePlan, WithoutPressureEverythingIsZero) {
  TargetField target;
  target.resize(3, 3);
  target.cell = 5e-3;
  const Metrics m = score_plan(target, Plan{}, 0, kSigma, kGain);
  EXPECT_EQ(m.rmse, 0.0);
  EXPECT_EQ(m.skill_0, 0.0);
  EXPECT_TRUE(controls(target, kSigma, kGain, 0.14, nullptr, 1).empty());
}

TEST(Controls, AreFiniteForOneCellAndForEveryPattern) {
  const auto expect_finite = [](const TargetField& target) {
    for (const Control& control : controls(target, kSigma, kGain, 0.14, nullptr, 3)) {
      const Metrics& m = control.metrics;
      for (const double v :
           {m.rmse, m.correlation, m.coverage, m.skill_0, m.skill_8, m.overlap, m.spill}) {
        EXPECT_TRUE(std::isfinite(v)) << control.name;
      }
      EXPECT_GE(m.coverage, 0.0);
      EXPECT_LE(m.coverage, 1.0);
    }
  };
  TargetField cell;
  cell.resize(1, 1);
  cell.cell = 5e-3;
  cell.skin[0] = 1;
  cell.pressure[0] = 1e-290;
  expect_finite(cell);
  for (const fields::Pattern pattern : fields::kPatterns) expect_finite(fields::make(pattern, 0));
}

TEST(Controls, OfRandomCirclesAreTheMedianOfTheirDraws) {
  const TargetField target = fields::make(fields::Pattern::FourPlumes, 50);
  Random random(3);
  std::vector<double> skills;
  for (int draw = 0; draw < 20; ++draw) {
    const Plan plan = random_circles(target, kSigma, kGain, 0.14, random);
    skills.push_back(score_plan(target, plan, 0, kSigma, kGain).skill_0);
    EXPECT_LE(plan.paths.size(), 4U);
  }
  std::ranges::sort(skills);
  const std::vector<Control> table = controls(target, kSigma, kGain, 0.14, nullptr, 3);
  EXPECT_NEAR(table.back().metrics.skill_0, 0.5 * (skills[9] + skills[10]), 1e-9);
}

TEST(Controls, OneCircleHasTheMeanDistanceOfThePressure) {
  // a ring of single cells about the middle of a cell, so of a known centre and distance
  constexpr double kRadius = 0.02, kCell = 0.5e-3;
  TargetField target;
  target.resize(101, 101);
  target.cell = kCell;
  std::fill(target.skin.begin(), target.skin.end(), std::uint8_t{1});
  const Vec2 middle = target.position(50, 50);
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const double distance = (target.position(row, col) - middle).norm();
      target.pressure[target.index(row, col)] =
          std::abs(distance - kRadius) < 0.9 * kCell ? 3.0 : 0.0;
    }
  }
  const auto circle_of = [&](double least_length, double most_length) {
    const Plan plan = circle_at_mean_distance(target, kGain, least_length, most_length);
    EXPECT_EQ(plan.paths.size(), 1U);
    return plan.paths.at(0);
  };
  const FocalPath circle = circle_of(0.01, 1.0);
  Vec2 centre = Vec2::Zero();
  for (const Vec2& point : circle.points)
    centre += point / static_cast<double>(circle.points.size());
  EXPECT_LT((centre - middle).norm(), 1e-9);
  EXPECT_NEAR(circle.length, 2.0 * kPi * kRadius, 0.01 * circle.length);
  EXPECT_DOUBLE_EQ(circle.pressure[0], 3.0 * kGain.of(circle.period));
  EXPECT_NEAR(circle_of(0.01, 0.1).length, 0.1, 1e-12);
  EXPECT_NEAR(circle_of(0.2, 1.0).length, 0.2, 1e-12);
  std::fill(target.pressure.begin(), target.pressure.end(), 0.0);
  EXPECT_TRUE(circle_at_mean_distance(target, kGain, 0.01, 1.0).empty());
  Random random(1);
  EXPECT_TRUE(random_circles(target, kSigma, kGain, 0.14, random).empty());
}

TEST(Controls, ReportTheProgressAfterEachField) {
  const TargetField target = fields::make(fields::kPatterns[0], 0);
  Plan paths, foci;
  paths.paths.push_back({0, {Vec2(0, 0), Vec2(0.03, 0)}, {1.0, 1.0}, 0.06, 7.0, 0.06 / 7.0});
  foci.foci.push_back({0, Vec2(0, 0), 1.0});
  for (const Plan* other :
       {static_cast<const Plan*>(nullptr), &std::as_const(paths), &std::as_const(foci)}) {
    int last = 0, of = 0;
    controls(target, kSigma, kGain, 0.14, other, 1, [&](int done, int all) {
      EXPECT_GT(done, last);
      last = done;
      of = all;
    });
    EXPECT_EQ(last, of);
    EXPECT_GT(of, 20);
  }
}

TEST(Controls, RandomFociAndFociOfAnotherTargetScoreBelowPlannedOnes) {
  AmPlanner planner(AmSettings{}, fields::make(fields::Pattern::Ring, 0).size());
  Plan plan, other;
  PlanStats stats;
  double planned = 0.0, random = 0.0, moved = 0.0;
  for (std::size_t k = 0; k < fields::kPatterns.size(); ++k) {
    const TargetField target = fields::make(fields::kPatterns[k], 5);
    planner.plan(fields::make(fields::kPatterns[(k + 3) % 9], 5), other, stats);
    planner.plan(target, plan, stats);
    planned += score_plan(target, plan, 0, kSigma, kGain).correlation;
    for (const Control& control : controls(target, kSigma, kGain, 0.14, &other, 1)) {
      if (control.name == "random foci, solved pressures") random += control.metrics.correlation;
      if (control.name == "foci of another target") moved += control.metrics.correlation;
      EXPECT_NE(control.name, "paths of another target");
    }
  }
  EXPECT_GT(random, 0.0);
  EXPECT_NE(moved, 0.0);
  EXPECT_GT(planned, 1.2 * random);
  EXPECT_GT(planned, 1.2 * moved);
}

TEST(WeightedRmse, WeightsErrorsByTheField) {
  for (const fields::Pattern pattern : fields::kPatterns) {
    TargetField target = fields::make(pattern, 3);
    Plan plan;
    PlanStats stats;
    Planner(PlanSettings{}, target.size()).plan(target, plan, stats);
    const double rmse = score_plan(target, plan, 0, kSigma, kGain).rmse;
    target.weight.assign(target.size(), 1e-300);
    EXPECT_NEAR(weighted_rmse(target, plan, 0, kSigma, kGain), rmse, 1e-12);

    // a single weighted cell: its own error
    const std::size_t cell = target.index(40, 40);
    ASSERT_EQ(target.skin[cell], 1);
    target.weight.assign(target.size(), 0.0);
    target.weight[cell] = 1e300;
    std::vector<double> rendered(target.size());
    quasi_static_field(plan, 0, target, kSigma, kGain, rendered);
    EXPECT_NEAR(weighted_rmse(target, plan, 0, kSigma, kGain),
                std::abs(rendered[cell] - target.pressure[cell]) / max_pressure(target), 1e-12);
  }
}

TEST(Controls, SolvedPressuresBeatAConstantPressureOnTheSameCircles) {
  // one hump under one small circle: the solved pressures give a positive skill
  TargetField target;
  target.resize(31, 31);
  target.cell = 2e-3;
  target.origin = Vec2(-0.03, -0.03);
  for (int row = 0; row < 31; ++row) {
    for (int col = 0; col < 31; ++col) {
      target.skin[target.index(row, col)] = 1;
      target.pressure[target.index(row, col)] =
          std::exp(-0.5 * target.position(row, col).squaredNorm() / (0.012 * 0.012));
    }
  }
  const std::vector<Control> table = controls(target, kSigma, kGain, 0.06, nullptr, 1);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_EQ(table[0].name, "flat field");
  EXPECT_NEAR(table[0].metrics.skill_0, 0.0, 1e-9);
  EXPECT_GT(table[2].metrics.skill_0, 0.1);
}

}  // namespace
}  // namespace prostm
