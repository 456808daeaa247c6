#include "prostm/study/analysis/effects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Json = nlohmann::json;
using Values = std::vector<double>;

void expect_near(double found, const Json& expected, const Json& line) {
  const auto wanted = expected.get<double>();
  EXPECT_NEAR(found, wanted, 1e-6 * (1.0 + std::abs(wanted))) << line;
}

void expect_sizes(const TwoSamples& of, const Json& expected, const Json& line) {
  const double level = line["level"], bound = line["bound"];
  const auto difference = mean_difference(of, level), effect = standardised_difference(of, level);
  const auto equal = equivalence(of, bound, 1.0 - level);
  const auto factor = bayes_factor(of);
  ASSERT_TRUE(difference && effect && equal && factor) << line;
  expect_near(difference->value, expected["difference"][0], line);
  expect_near(difference->interval.low, expected["difference"][1], line);
  expect_near(difference->interval.high, expected["difference"][2], line);
  expect_near(effect->value, expected["d"][0], line);
  expect_near(effect->interval.low, expected["d"][1], line);
  expect_near(effect->interval.high, expected["d"][2], line);
  expect_near(equal->p_above_low, expected["equal"][0], line);
  expect_near(equal->p_below_high, expected["equal"][1], line);
  expect_near(equal->interval.low, expected["equal"][2], line);
  expect_near(equal->interval.high, expected["equal"][3], line);
  expect_near(*factor, expected["bayes_factor"], line);
}

TEST(Effects, AgreeWithScipyAndStatsmodelsOnThreeHundredDataSets) {
  const test::WithoutTraps in_boost;
  std::ifstream file(test::source_file("tests/study/analysis/expected_effects.jsonl"));
  int lines = 0, paired = 0;
  for (std::string text; std::getline(file, text); ++lines) {
    const Json line = Json::parse(text);
    const Values a = line["a"], b = line["b"];
    expect_sizes({a, b, Groups::Between}, line["groups"], line);
    if (!line["pairs"].is_null()) expect_sizes({a, b, Groups::Within}, line["pairs"], line);
    paired += line["pairs"].is_null() ? 0 : 1;
    const Values p = line["p"], corrected = holm(p);
    ASSERT_EQ(corrected.size(), line["holm"].size());
    for (std::size_t i = 0; i < p.size(); ++i) expect_near(corrected[i], line["holm"][i], line);
  }
  EXPECT_EQ(lines, 300);
  EXPECT_GT(paired, 150);
}

// Student's sleep data, with the Bayes factor that the manual of R's BayesFactor gives for them
// (R. D. Morey and J. N. Rouder, "Using the BayesFactor package", section on one sample).
TEST(Effects, BayesFactorMatchesPublishedOnes) {
  const test::WithoutTraps in_boost;
  const Values first = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0},
               second = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  EXPECT_NEAR(*bayes_factor({first, second, Groups::Within}), 17.25888, 5e-6);
  // weights of chicks by feed, R's chickwts; 5.98 in the manual, more digits by BayesFactor 0.9.12
  const Values horsebean = {179, 160, 136, 227, 217, 168, 108, 124, 143, 140},
               linseed = {309, 229, 181, 141, 260, 203, 148, 169, 213, 257, 244, 271};
  EXPECT_NEAR(*bayes_factor({horsebean, linseed, Groups::Between}), 5.975741, 5e-6);
  // Rouder et al., Psychon. Bull. Rev. 16, 225 (2009), with scale 1: of Grider and Malmberg's t(79)
  EXPECT_NEAR(1.0 / jzs_bayes_factor(2.24, 80.0, 79.0, 1.0), 1.02, 0.005);
  EXPECT_NEAR(1.0 / jzs_bayes_factor(2.03, 80.0, 79.0, 1.0), 1.56, 0.005);
  // beyond the range of doubles
  EXPECT_EQ(jzs_bayes_factor(581.98, 200.0, 199.0), std::numeric_limits<double>::max());
}

// Student's sleep data within ± 0.5, as in "Introduction to t_TOST" of R's TOSTER (A. Caldwell):
// t(17.78) = -1.272, p = 0.89 and t = -2.450, p = 0.012; paired t(9) = -2.777, p = 0.989.
TEST(Effects, EquivalenceMatchesPublishedOnes) {
  const test::WithoutTraps in_boost;
  const Values first = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0},
               second = {1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  const auto groups = equivalence({first, second, Groups::Between}, 0.5);
  EXPECT_NEAR(groups->p_below_high, 0.89, 0.005);
  EXPECT_NEAR(groups->p_above_low, 0.012, 0.0005);
  const auto pairs = equivalence({first, second, Groups::Within}, 0.5);
  EXPECT_NEAR(pairs->p(), 0.989, 0.0005);
}

TEST(Effects, BayesFactorIsSymmetricAndFinite) {
  const test::WithoutTraps in_boost;
  EXPECT_DOUBLE_EQ(jzs_bayes_factor(2.5, 12.0, 11.0), jzs_bayes_factor(-2.5, 12.0, 11.0));
  EXPECT_LT(jzs_bayes_factor(0.0, 1000.0, 999.0), 0.1);
  EXPECT_GT(jzs_bayes_factor(30.0, 200.0, 199.0), 1e50);
  EXPECT_TRUE(std::isfinite(jzs_bayes_factor(60.0, 300.0, 299.0)));
  EXPECT_NEAR(jzs_bayes_factor(1.0, 10.0, 9.0, 1e-4), 1.0, 1e-3);  // a prior of hardly any effect
}

TEST(Effects, EquivalenceIsTheIntervalInsideTheBounds) {
  const test::WithoutTraps in_boost;
  const Values a = {0.61, 0.70, 0.55, 0.64, 0.72, 0.58, 0.66, 0.69},
               b = {0.63, 0.69, 0.57, 0.66, 0.70, 0.60, 0.65, 0.71};
  const TwoSamples pairs{a, b, Groups::Within};
  const Interval interval = equivalence(pairs, 0.1)->interval;
  const double reach = std::max(-interval.low, interval.high);
  EXPECT_LT(equivalence(pairs, 1.001 * reach)->p(), 0.05);
  EXPECT_GT(equivalence(pairs, 0.999 * reach)->p(), 0.05);
  const Interval at_90 = mean_difference(pairs, 0.9)->interval;
  EXPECT_NEAR(interval.low, at_90.low, 1e-12);
  EXPECT_NEAR(interval.high, at_90.high, 1e-12);
}

TEST(Effects, ConstantSamplesHaveNone) {
  const Values same = {0.7, 0.7}, other = {0.9, 0.9}, one = {0.5};
  for (const Groups groups : {Groups::Between, Groups::Within}) {
    const TwoSamples of{same, other, groups};
    EXPECT_FALSE(mean_difference(of));
    EXPECT_FALSE(standardised_difference(of));
    EXPECT_FALSE(equivalence(of, 0.1));
    EXPECT_FALSE(bayes_factor(of));
  }
  EXPECT_FALSE(mean_difference({one, same, Groups::Between}));
}

// Smaller p are multiplied by more.
TEST(Effects, HolmStepsDown) {
  EXPECT_TRUE(holm({}).empty());
  const Values p = {0.03, 0.01, 0.04}, corrected = holm(p);
  EXPECT_NEAR(corrected[0], 0.06, 1e-12);
  EXPECT_NEAR(corrected[1], 0.03, 1e-12);
  EXPECT_NEAR(corrected[2], 0.06, 1e-12);  // not below that of a smaller p
  EXPECT_EQ(holm(std::array{0.8, 0.9}).front(), 1.0);
}

}  // namespace
}  // namespace prostm
