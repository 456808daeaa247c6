#include "prostm/study/task/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/hypergeometric.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/core/random.hpp"
#include "study/power_reference.hpp"
#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Json = nlohmann::json;
using Values = std::vector<double>;

constexpr double kNear = 1e-6;

Values shares(const std::vector<int>& counts, int trials) {
  Values out;
  for (const int count : counts) out.push_back(static_cast<double>(count) / trials);
  return out;
}

std::vector<Proportion> proportions(const std::vector<int>& counts, int trials) {
  std::vector<Proportion> out;
  for (const int count : counts) out.push_back({count, trials});
  return out;
}

Proportion total(const std::vector<int>& counts, int trials) {
  Proportion out;
  for (const int count : counts) out.successes += count, out.trials += trials;
  return out;
}

/// @param expected [statistic, df, p], or null.
void expect_test(const std::optional<TestResult>& test, const Json& expected, const Json& line) {
  ASSERT_EQ(test.has_value(), !expected.is_null()) << line;
  if (!test) return;
  EXPECT_NEAR(test->statistic, expected[0].get<double>(), kNear * (1.0 + std::abs(test->statistic)))
      << line;
  EXPECT_NEAR(test->df, expected[1].get<double>(), kNear * test->df) << line;
  EXPECT_NEAR(test->p, expected[2].get<double>(), kNear) << line;
}

void expect_proportions(const Json& line) {
  const int trials = line["trials"];
  const Proportion a = total(line["a"], trials), b = total(line["b"], trials);
  const Interval wilson = wilson_interval(a);
  EXPECT_NEAR(wilson.low, line["wilson"][0].get<double>(), kNear) << line;
  EXPECT_NEAR(wilson.high, line["wilson"][1].get<double>(), kNear) << line;
  const TestResult z = two_proportions_z(a, b);
  EXPECT_NEAR(z.statistic, line["z"][0].get<double>(), kNear) << line;
  EXPECT_NEAR(z.p, line["z"][1].get<double>(), kNear) << line;
  EXPECT_NEAR(fisher_exact_p(a, b), line["fisher"].get<double>(), kNear) << line;
  EXPECT_NEAR(binomial_p(a, line["chance"]), line["binomial"].get<double>(), kNear) << line;
  expect_test(dispersion(proportions(line["a"], trials)), line["dispersion"], line);
  const Sensitivity s = sensitivity({line["a"][0], trials}, {line["b"][0], trials});
  EXPECT_NEAR(s.d_prime, line["sensitivity"][0].get<double>(), kNear) << line;
  EXPECT_NEAR(s.bias, line["sensitivity"][1].get<double>(), kNear) << line;
}

void expect_groups(const Json& line) {
  const int trials = line["trials"];
  const Values a = shares(line["a"], trials), b = shares(line["b"], trials);
  expect_test(welch_t(a, b), line["welch"], line);
  EXPECT_NEAR(permutation(a, b, 1).p, line["permutation"].get<double>(), kNear) << line;
  if (a.size() == b.size()) {
    expect_test(paired_t(a, b), line["paired"], line);
    EXPECT_NEAR(paired_permutation(a, b, 1).p, line["paired_permutation"].get<double>(), kNear)
        << line;
  }
  const Json& power = line["power"];
  EXPECT_NEAR(test::t_test_power(power[0], power[1], Groups::Between), power[2].get<double>(),
              kNear)
      << line;
  EXPECT_NEAR(test::t_test_power(power[0], power[1], Groups::Within), power[3].get<double>(), kNear)
      << line;
}

TEST(Statistics, AgreeWithScipyAndStatsmodelsOnAThousandDataSets) {
  const test::WithoutTraps in_boost;
  std::ifstream file(test::source_file("tests/study/expected.jsonl"));
  int lines = 0;
  for (std::string text; std::getline(file, text); ++lines) {
    const Json line = Json::parse(text);
    expect_proportions(line);
    expect_groups(line);
  }
  EXPECT_EQ(lines, 1000);
}

TEST(Statistics, MatchThePapersScores) {
  const test::WithoutTraps in_boost;
  const std::vector<int> am = {10, 8, 7, 12, 12, 7, 9, 13}, stm = {14, 15, 15, 14, 6, 11, 7, 15};
  const TestResult z = two_proportions_z(total(am, 16), total(stm, 16));
  EXPECT_NEAR(z.statistic, 2.553, 5e-4);
  EXPECT_NEAR(z.p, 0.0107, 5e-5);
  const Permutation splits = permutation(shares(am, 16), shares(stm, 16), 1);
  EXPECT_EQ(splits.splits, 12870);
  EXPECT_TRUE(splits.exact);
  EXPECT_NEAR(splits.p, 0.171, 5e-4);
  EXPECT_NEAR(dispersion(proportions(stm, 16))->statistic / 7.0, 4.7, 0.05);
  EXPECT_NEAR(*effect_size(shares(am, 16), shares(stm, 16)), 0.76, 0.005);
  EXPECT_EQ(
      test::participants_needed(*effect_size(shares(am, 16), shares(stm, 16)), Groups::Between),
      29);
}

// Sums of Boost's densities take a second for a hundred thousand answers.
TEST(Statistics, ExactTestsAreSumsOfDensities) {
  constexpr double kTie = 1.0 + 1e-7;
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    const int of_a = 1 + random.below(120), of_b = 1 + random.below(120);
    const Proportion a{random.below(of_a + 1), of_a}, b{random.below(of_b + 1), of_b};
    const int right = a.successes + b.successes;
    const boost::math::hypergeometric_distribution<> tables(static_cast<unsigned>(right),
                                                            static_cast<unsigned>(of_a),
                                                            static_cast<unsigned>(of_a + of_b));
    const auto likely = [&](int k) { return pdf(tables, static_cast<unsigned>(k)); };
    double fisher = 0.0;
    for (int k = std::max(0, right - of_b); k <= std::min(right, of_a); ++k)
      fisher += likely(k) <= likely(a.successes) * kTie ? likely(k) : 0.0;
    EXPECT_NEAR(fisher_exact_p(a, b), fisher, 1e-9 * fisher);

    const double chance = trial % 10 == 0 ? 0.5 : random.uniform(0.01, 0.99);
    const boost::math::binomial_distribution<> guesses(of_a, chance);
    double binomial = 0.0;
    for (int k = 0; k <= of_a; ++k)
      binomial += pdf(guesses, k) <= pdf(guesses, a.successes) * kTie ? pdf(guesses, k) : 0.0;
    EXPECT_NEAR(binomial_p(a, chance), binomial, 1e-9 * binomial);
  }
}

TEST(Statistics, ExactTestsOfManyAnswersApproachNormalOnes) {
  constexpr int kAll = 1'000'000;
  const Proportion a{500'000, kAll}, b{501'000, kAll};
  EXPECT_NEAR(fisher_exact_p(a, b), two_proportions_z(a, b).p, 1e-3);
  EXPECT_NEAR(binomial_p(b, 0.5), std::erfc(2.0 / std::sqrt(2.0)), 1e-3);
}

// Constant values have no test, and a table that is all right or all wrong shows no
// difference.
TEST(Statistics, OfConstantAnswersAreDefined) {
  EXPECT_EQ(two_proportions_z({8, 8}, {16, 16}).p, 1.0);
  EXPECT_EQ(two_proportions_z({0, 8}, {0, 16}).statistic, 0.0);
  EXPECT_NEAR(fisher_exact_p({8, 8}, {16, 16}), 1.0, 1e-12);
  const Values same = {0.7, 0.7, 0.7}, other = {0.9, 0.9, 0.9}, one = {0.5};
  EXPECT_FALSE(welch_t(same, other));
  EXPECT_FALSE(effect_size(same, other));
  EXPECT_FALSE(paired_t(same, other));
  EXPECT_FALSE(paired_effect_size(same, other));
  EXPECT_FALSE(welch_t(one, other));
  EXPECT_NEAR(permutation(same, same, 1).p, 1.0, 1e-12);
  EXPECT_NEAR(paired_permutation(same, same, 1).p, 1.0, 1e-12);
  EXPECT_NEAR(permutation(same, other, 1).p, 0.1, 1e-12);  // 2 of 20 splits
  EXPECT_FALSE(dispersion(std::array{Proportion{4, 4}, Proportion{6, 6}}));
  EXPECT_FALSE(dispersion(std::array{Proportion{3, 4}}));
  const Interval all = wilson_interval({8, 8}), none = wilson_interval({0, 8});
  EXPECT_NEAR(all.high, 1.0, 1e-12);
  EXPECT_NEAR(all.low, 1.0 - none.high, 1e-12);
}

// Both groups are from one population, so p must be below 5 % in at most 5 % of studies.
TEST(Statistics, RandomSplitsKeepTheirSignificanceLevel) {
  Random random(3);
  int below = 0;
  constexpr int kStudies = 40;
  for (int study = 0; study < kStudies; ++study) {
    Values a(12), b(12);
    for (double& x : a) x = random.normal();
    for (double& x : b) x = random.normal();
    const Permutation splits = permutation(a, b, 5);
    EXPECT_FALSE(splits.exact);
    EXPECT_EQ(splits.splits, kMostSplits);
    EXPECT_NEAR(splits.p, welch_t(a, b)->p, 0.03);
    below += splits.p < 0.05 ? 1 : 0;
  }
  EXPECT_LE(below, 6);  // 5 % of 40 is 2; 7 or more has a chance of 0.3 %
}

TEST(Statistics, RandomSplitsApproximateAllSplits) {
  const Values a = {0.4, 0.5, 0.7, 0.6, 0.9, 0.55, 0.3, 0.8, 0.45},
               b = {0.6, 0.9, 0.8, 0.75, 0.85, 0.5, 0.95, 0.7, 0.65};
  const double exact = permutation(a, b, 1).p;  // 48 620 splits
  Values longer_a = a, longer_b = b;  // two more values in each: C(22, 11) splits are too many
  for (const double x : {0.6, 0.7}) longer_a.push_back(x), longer_b.push_back(x);
  const Permutation sampled = permutation(longer_a, longer_b, 1),
                    again = permutation(longer_a, longer_b, 1);
  EXPECT_TRUE(permutation(a, b, 1).exact);
  EXPECT_FALSE(sampled.exact);
  EXPECT_EQ(sampled.p, again.p);
  EXPECT_NEAR(sampled.p, welch_t(longer_a, longer_b)->p, 0.02);
  EXPECT_NEAR(exact, welch_t(a, b)->p, 0.02);
  Values pairs_a(20), pairs_b(20);
  Random random(8);
  for (std::size_t i = 0; i < pairs_a.size(); ++i)
    pairs_b[i] = 0.4 + (pairs_a[i] = random.normal()) + random.normal();
  const Permutation signs = paired_permutation(pairs_a, pairs_b, 2);
  EXPECT_FALSE(signs.exact);
  EXPECT_NEAR(signs.p, paired_t(pairs_a, pairs_b)->p, 0.02);
}

TEST(Statistics, ChanceOfALeadFollowsFromTheCounts) {
  // one answer of one person: the second is right and the first is not
  EXPECT_NEAR(chance_of_lead({1, 1, 0.7, 0.3}, 1), 0.7 * 0.3, 1e-12);
  // two answers that always agree
  EXPECT_NEAR(chance_of_lead({1, 2, 0.5, 0.999999}, 2), 0.25, 1e-5);
  // independent answers: those of one person are those of many
  EXPECT_NEAR(chance_of_lead({8, 16, 0.684, 1e-7}, 19), chance_of_lead({128, 1, 0.684, 0.5}, 19),
              1e-6);
  EXPECT_LT(2.0 * chance_of_lead({4, 10, 0.6, 0.2}, 1), 1.0);  // and ties have the rest
  // computed apart, in Python
  const std::pair<double, double> computed[] = {{0.05, 0.03002}, {0.10, 0.05794}, {0.15, 0.08409}};
  for (const auto& [correlation, chance] : computed)
    EXPECT_NEAR(chance_of_lead({8, 16, 175.0 / 256.0, correlation}, 19), chance, 1e-5);
}

}  // namespace
}  // namespace prostm
