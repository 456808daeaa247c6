#include "prostm/score/disturbance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 8.6e-3;
constexpr GainLaw kGain{1.4};

/// Returns exp(−r²/2σ²) around the middle of a square of skin with 1 mm cells.
TargetField gaussian_target(double sigma) {
  TargetField target;
  target.resize(121, 121);
  target.cell = 1e-3;
  target.origin = Vec2::Constant(-0.06);
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      target.skin[target.index(row, col)] = 1;
      target.pressure[target.index(row, col)] =
          std::exp(-0.5 * target.position(row, col).squaredNorm() / (sigma * sigma));
    }
  }
  return target;
}

/// Returns a regular polygon around the middle; with a radius of 0.1 µm it renders a single
/// Gaussian.
Plan polygon(int corners, double radius) {
  FocalPath path;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPi * i / corners;
    path.points.push_back(radius * Vec2(std::cos(angle), std::sin(angle)));
    path.pressure.push_back(kGain.gain);
  }
  Plan plan;
  plan.paths.push_back(path);
  return plan;
}

void expect_equal(const Metrics& a, const Metrics& b) {
  EXPECT_EQ(a.rmse, b.rmse);
  EXPECT_EQ(a.correlation, b.correlation);
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.skill_0, b.skill_0);
  EXPECT_EQ(a.skill_8, b.skill_8);
  EXPECT_EQ(a.overlap, b.overlap);
  EXPECT_EQ(a.spill, b.spill);
}

TEST(ScoreDisturbed, OfZeroSizeGivesTheScoreExactly) {
  const TargetField target = gaussian_target(0.02);
  const Plan plan = polygon(20, 0.018);
  const Metrics plain = score_plan(target, plan, 0, kSigma, kGain);
  expect_equal(score_disturbed(target, plan, 0, {"none", kSigma, 0.0}, kGain), plain);
  expect_equal(score_shifted(target, plan, 0, kSigma, kGain, Vec2::Zero()), plain);
  expect_equal(score_disturbed(target, plan, 0, {"narrow", 3.9e-3, 0.0}, kGain),
               score_plan(target, plan, 0, 3.9e-3, kGain));
}

TEST(ScoreDisturbed, AShiftedGaussianHasItsClosedFormError) {
  const TargetField target = gaussian_target(kSigma);
  const Plan point = polygon(8, 1e-7);
  const double area = 121 * 121 * 1e-6;
  for (const double shift : {1e-3, 3e-3, 5e-3}) {
    // ∫ (G(x) − G(x − e))² = 2 π σ² (1 − exp(−e²/4σ²)); the correlation is nearly that of the
    // products
    const double exact =
        std::sqrt(2.0 * kPi * kSigma * kSigma *
                  (1.0 - std::exp(-0.25 * shift * shift / (kSigma * kSigma))) / area);
    const Metrics m = score_disturbed(target, point, 0, {"shift", kSigma, shift}, kGain);
    EXPECT_NEAR(m.rmse, exact, 1e-4 * exact);
    EXPECT_LT(m.skill_0, 1.0 - 1e-3);
  }
}

TEST(ScoreDisturbed, AWiderFocusHasItsClosedFormError) {
  const TargetField target = gaussian_target(kSigma);
  const Plan point = polygon(8, 1e-7);
  const double area = 121 * 121 * 1e-6;
  for (const Disturbance& d : disturbances(kSigma)) {
    if (d.shift > 0.0) continue;
    // ∫ (G_σ − G_s)² = π (σ² + s²) − 4 π σ² s² / (σ² + s²)
    const double a = kSigma * kSigma, b = d.sigma * d.sigma;
    const double exact = std::sqrt((kPi * (a + b) - 4.0 * kPi * a * b / (a + b)) / area);
    EXPECT_NEAR(score_disturbed(target, point, 0, d, kGain).rmse, exact, 2e-3 * exact) << d.name;
  }
}

TEST(ScoreDisturbed, TheDirectionOfAShiftDoesNotMatterToASymmetricPlan) {
  // a regular 16-gon on a round target: the result is the same for every direction of the shift
  const TargetField target = gaussian_target(0.015);
  const Plan plan = polygon(16, 0.015);
  const Metrics first = score_shifted(target, plan, 0, kSigma, kGain, Vec2(5e-3, 0.0));
  for (int quarter = 1; quarter < 4; ++quarter) {
    const double angle = 0.5 * kPi * quarter;
    const Metrics m = score_shifted(target, plan, 0, kSigma, kGain,
                                    5e-3 * Vec2(std::cos(angle), std::sin(angle)));
    EXPECT_NEAR(m.rmse, first.rmse, 1e-9);
    EXPECT_NEAR(m.skill_8, first.skill_8, 1e-9);
  }
  // between the axes only the square shape of skin and cells matters
  const Metrics between =
      score_shifted(target, plan, 0, kSigma, kGain, 5e-3 * std::sqrt(0.5) * Vec2(1.0, 1.0));
  EXPECT_NEAR(between.rmse, first.rmse, 1e-4);
  const Metrics mean = score_disturbed(target, plan, 0, {"shift", kSigma, 5e-3}, kGain);
  EXPECT_NEAR(mean.rmse, 0.5 * (first.rmse + between.rmse), 1e-9);
  EXPECT_NEAR(mean.skill_8, 0.5 * (first.skill_8 + between.skill_8), 1e-9);
}

TEST(ScoreDisturbed, LargerDisturbancesWorsenAPlanThatFits) {
  const TargetField target = gaussian_target(kSigma);
  const Plan point = polygon(8, 1e-7);
  double before = score_plan(target, point, 0, kSigma, kGain).skill_8;
  EXPECT_NEAR(before, 1.0, 1e-6);
  for (const double shift : {2e-3, 4e-3, 8e-3}) {
    const double skill = score_disturbed(target, point, 0, {"shift", kSigma, shift}, kGain).skill_8;
    EXPECT_LT(skill, before);
    before = skill;
  }
}

TEST(Disturbances, AreTheFiveOfTheDesign) {
  const std::vector<Disturbance> list = disturbances(kSigma);
  ASSERT_EQ(list.size(), 5u);
  EXPECT_DOUBLE_EQ(list[0].sigma, 3.9e-3);
  EXPECT_DOUBLE_EQ(list[1].sigma, 0.7 * kSigma);
  EXPECT_DOUBLE_EQ(list[2].sigma, 1.3 * kSigma);
  EXPECT_DOUBLE_EQ(list[3].shift, 3e-3);
  EXPECT_DOUBLE_EQ(list[4].shift, 5e-3);
}

}  // namespace
}  // namespace prostm
