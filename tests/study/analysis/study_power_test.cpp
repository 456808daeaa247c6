#include "prostm/study/analysis/study_power.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "study/power_reference.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

constexpr int kStudies = 4000;

StudyDesign of_effect(Groups groups, double d) {
  StudyDesign out;
  out.groups = groups;
  out.d = d;
  return out;
}

StudyDesign of_shares(Groups groups, const AssumedShares& shares, double alpha = 0.05) {
  StudyDesign out;
  out.groups = groups;
  out.shares = shares;
  out.alpha = alpha;
  return out;
}

/// Four standard errors of a simulated share.
double tolerance(double power) {
  return 4.0 * std::sqrt(power * (1.0 - power) / kStudies) + 1e-3;
}

// Groups have equal variances and sizes, so that Welch's test hardly loses degrees of freedom.
TEST(StudyPower, OfAnEffectSizeIsThatOfTheNoncentralT) {
  const test::WithoutTraps in_boost;
  for (const Groups groups : {Groups::Between, Groups::Within}) {
    for (const double d : {0.3, 0.6, 1.0}) {
      SimulatedStudies studies(of_effect(groups, d), kStudies, 5);
      for (const int n : {8, 16, 40}) {
        const double exact = test::t_test_power(d, n, groups);
        EXPECT_NEAR(studies.power(n).value(), exact, tolerance(exact)) << d << ' ' << n;
      }
      for (const double power : {0.8, 0.9}) {
        const double exact = test::participants_needed(d, groups, power);
        EXPECT_NEAR(*studies.needed(power), exact, 1.0 + 0.06 * exact) << d;
      }
    }
  }
}

TEST(StudyPower, WithoutADifferenceIsAtMostAlpha) {
  const test::WithoutTraps in_boost;
  for (const Groups groups : {Groups::Between, Groups::Within}) {
    const AssumedShares same = {.first = 0.7, .second = 0.7, .trials = 16};
    SimulatedStudies studies(of_shares(groups, same, 0.1), kStudies, 3);
    EXPECT_NEAR(studies.power(20).value(), 0.1, tolerance(0.1));
    EXPECT_FALSE(studies.needed(0.8, 100));
  }
}

// The variance of a share is ρ p (1 − p), and that of its estimate from n trials
// p (1 − p) (1 + (n − 1) ρ) / n.
TEST(StudyPower, OfSharesIsThatOfTheirVariance) {
  const test::WithoutTraps in_boost;
  const AssumedShares shares = {.first = 0.6, .second = 0.75, .trials = 16, .correlation = 0.15};
  SimulatedStudies studies(of_shares(Groups::Between, shares), kStudies, 9);
  const auto variance = [&](double p) { return p * (1.0 - p) * (1.0 + 15.0 * 0.15) / 16.0; };
  const double d = 0.15 / std::sqrt(0.5 * (variance(0.6) + variance(0.75)));
  for (const int n : {15, 30}) {
    const double exact = test::t_test_power(d, n, Groups::Between);
    EXPECT_NEAR(studies.power(n).value(), exact, tolerance(exact) + 0.015);
  }
}

TEST(StudyPower, GrowsIfPeopleAreAlikeWithBothMethods) {
  const test::WithoutTraps in_boost;
  const auto needed = [](double alike, int trials) {
    const AssumedShares shares = {
        .first = 0.6, .second = 0.7, .trials = trials, .correlation = 0.2, .alike = alike};
    return *SimulatedStudies(of_shares(Groups::Within, shares), 1000, 2).needed(0.8);
  };
  EXPECT_LT(needed(0.9, 32), needed(0.0, 32));
  EXPECT_LT(needed(0.5, 64), needed(0.5, 8));
}

TEST(StudyPower, DependsOnTheSeedAlone) {
  const StudyDesign design = of_shares(Groups::Between, {.first = 0.5, .second = 0.7});
  SimulatedStudies first(design, 300, 7), again(design, 300, 7), other(design, 300, 8);
  const int after_more = (static_cast<void>(first.power(40)), first.power(20).successes);
  EXPECT_EQ(again.power(20).successes, after_more);
  EXPECT_EQ(again.needed(0.8), first.needed(0.8));
  EXPECT_NE(other.power(20).successes, after_more);
}

TEST(StudyPower, RefusesDesignsOutOfBounds) {
  constexpr Groups kBetween = Groups::Between;
  validate(of_shares(kBetween, {}));
  EXPECT_THROW(validate(of_shares(kBetween, {}, 0.0)), std::invalid_argument);
  EXPECT_THROW(validate(of_effect(kBetween, 0.0)), std::invalid_argument);
  EXPECT_THROW(validate(of_shares(kBetween, {.first = 0.0})), std::invalid_argument);
  EXPECT_THROW(validate(of_shares(kBetween, {.second = 1.0})), std::invalid_argument);
  EXPECT_THROW(validate(of_shares(kBetween, {.trials = 0})), std::invalid_argument);
  EXPECT_THROW(validate(of_shares(kBetween, {.correlation = 0.0})), std::invalid_argument);
  EXPECT_THROW(validate(of_shares(kBetween, {.alike = 1.0})), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
