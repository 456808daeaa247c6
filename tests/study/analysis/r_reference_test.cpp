/// Statistics of studies against those of R: t.test, p.adjust, prop.test, fisher.test, binom.test,
/// BayesFactor's ttestBF and BradleyTerry2's BTm (make_expected_r.R).

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/study/analysis/bradley_terry.hpp"
#include "prostm/study/analysis/effects.hpp"
#include "prostm/study/task/statistics.hpp"
#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Json = nlohmann::json;
using Values = std::vector<double>;

constexpr double kRelative = 1e-6;   // found: 1.6e-7 for Bayes factors, R integrates to 1e-4
constexpr double kAbsolute = 1e-15;  // for values near 0
constexpr double kZ95 = 1.959963984540054;

std::vector<Json> tables() {
  std::ifstream file(test::source_file("tests/study/analysis/expected_r.jsonl"));
  std::vector<Json> out;
  for (std::string text; std::getline(file, text);) out.push_back(Json::parse(text));
  return out;
}

void expect_near(double found, const Json& expected, const Json& of) {
  const auto wanted = expected.get<double>();
  EXPECT_NEAR(found, wanted, kRelative * std::abs(wanted) + kAbsolute) << of;
}

/// Compares b − a with R's test of the same samples.
void expect_samples(const TwoSamples& of, const Json& r, const Json& table) {
  const double level = table["level"], bound = table["bound"];
  const auto test = of.groups == Groups::Within ? paired_t(of.a, of.b) : welch_t(of.a, of.b);
  const auto difference = mean_difference(of, level);
  const auto equal = equivalence(of, bound);
  const auto factor = bayes_factor(of);
  ASSERT_TRUE(test && difference && equal && factor) << table;
  expect_near(test->statistic, r["t"], table);
  expect_near(test->df, r["df"], table);
  expect_near(test->p, r["p"], table);
  expect_near(difference->interval.low, r["interval"][0], table);
  expect_near(difference->interval.high, r["interval"][1], table);
  expect_near(equal->p_above_low, r["above_low"], table);
  expect_near(equal->p_below_high, r["below_high"], table);
  if (!r["bayes_factor"].is_null()) expect_near(*factor, r["bayes_factor"], table);
}

TEST(RReference, DifferencesOfTwoMethods) {
  const test::WithoutTraps in_boost;
  int lines = 0, paired = 0;
  for (const Json& table : tables()) {
    const Values a = table["a"], b = table["b"];
    expect_samples({a, b, Groups::Between}, table["groups"], table);
    ++lines;
    if (table["pairs"].is_null()) continue;
    expect_samples({a, b, Groups::Within}, table["pairs"], table);
    ++paired;
  }
  EXPECT_EQ(lines, 240);
  EXPECT_GT(paired, 120);
}

TEST(RReference, HolmsCorrection) {
  for (const Json& table : tables()) {
    const Values p = table["p"], corrected = holm(p);
    ASSERT_EQ(corrected.size(), table["holm"].size());
    for (std::size_t i = 0; i < p.size(); ++i) expect_near(corrected[i], table["holm"][i], table);
  }
}

// prop.test's χ² of two proportions is the square of z, and its interval of one is Wilson's.
TEST(RReference, RightAnswers) {
  const test::WithoutTraps in_boost;
  for (const Json& table : tables()) {
    const Json& of = table["counts"];
    const Proportion a{of["right"][0], of["trials"][0]}, b{of["right"][1], of["trials"][1]};
    const TestResult z = two_proportions_z(a, b);
    expect_near(z.statistic * z.statistic, of["chi_squared"], table);
    expect_near(z.p, of["p"], table);
    expect_near(fisher_exact_p(a, b), of["fisher"], table);
    expect_near(binomial_p(a, 0.5), of["binomial"], table);
    const Interval wilson = wilson_interval(a, table["level"]);
    expect_near(wilson.low, of["wilson"][0], table);
    expect_near(wilson.high, of["wilson"][1], table);
  }
}

/// s0, s1, …, compared as often as wins[i][k] says.
BradleyTerry fit_of(const Json& wins) {
  std::vector<PairedComparison> of;
  for (std::size_t i = 0; i < wins.size(); ++i) {
    for (std::size_t k = 0; k < wins.size(); ++k) {
      of.insert(of.end(), wins[i][k].get<std::size_t>(),
                {"", "s" + std::to_string(i), "s" + std::to_string(k)});
    }
  }
  return fit_bradley_terry(of);
}

// BTm's reference category is s0, whose ability is 0: its abilities are differences from s0. Ours
// sum to 0; the file has both.
TEST(RReference, AbilitiesOfStimuli) {
  const test::WithoutTraps in_boost;
  for (const Json& table : tables()) {
    const BradleyTerry fit = fit_of(table["wins"]);
    const Json& r = table["abilities"];
    ASSERT_EQ(fit.stimuli.size(), r["over_mean"].size());
    for (const StimulusAbility& of : fit.stimuli) {
      const auto i = static_cast<std::size_t>(std::stoi(of.stimulus.substr(1)));
      expect_near(of.ability, r["over_mean"][i], table);
      expect_near(of.error, r["over_mean_error"][i], table);
    }
    for (const AbilityDifference& of : fit.differences) {
      if (of.first != "s0" && of.second != "s0") continue;
      const bool turned = of.second == "s0";
      const auto i = static_cast<std::size_t>(std::stoi((turned ? of.first : of.second).substr(1)));
      expect_near(turned ? -of.difference : of.difference, r["over_first"][i], table);
      expect_near(of.error, r["over_first_error"][i], table);
      expect_near(of.p, r["p"][i - 1], table);
      EXPECT_NEAR(of.interval.high - of.interval.low, 2.0 * kZ95 * of.error, 1e-9);
    }
    const int df = r["df"];
    ASSERT_EQ(fit.misfit.has_value(), df > 0) << table;
    if (!fit.misfit) continue;
    expect_near(fit.misfit->statistic, r["deviance"], table);
    EXPECT_EQ(fit.misfit->df, df);
  }
}

}  // namespace
}  // namespace prostm
