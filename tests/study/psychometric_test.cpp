#include "prostm/study/psychometric.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/core/random.hpp"
#include "support/input_errors.hpp"
#include "support/places.hpp"

namespace prostm {
namespace {

using Scores = std::vector<LevelScore>;

/// Answers of an observer at `levels` levels from 0 to 1.
Scores simulate(const Psychometric& observer, int levels, int trials, Random& random) {
  Scores out;
  for (int i = 0; i < levels; ++i) {
    LevelScore& score = out.emplace_back();
    score.level = static_cast<double>(i) / (levels - 1);
    score.correct.trials = trials;
    for (int trial = 0; trial < trials; ++trial)
      score.correct.successes += random.uniform() < observer.at(score.level) ? 1 : 0;
  }
  return out;
}

TEST(Psychometric, AgreesWithLogisticRegressionOnAThousandDataSets) {
  const test::WithoutTraps in_boost;
  std::ifstream file(test::source_file("tests/study/expected.jsonl"));
  int fits = 0, steps = 0, far = 0;
  for (std::string text; std::getline(file, text);) {
    const nlohmann::json data = nlohmann::json::parse(text)["logistic"];
    Scores scores;
    for (std::size_t i = 0; i < data["levels"].size(); ++i)
      scores.push_back({data["levels"][i], {data["right"][i], data["trials"][i]}});
    const auto fit = fit_psychometric(scores, 0.0, 0.0);
    if (data["fit"] == "step") {
      EXPECT_FALSE(fit) << data;
      ++steps;
      continue;
    }
    if (data["fit"].is_null()) {
      ++far;
      continue;
    }
    ASSERT_TRUE(fit) << data;
    const double threshold = data["fit"][0], slope = data["fit"][1];
    EXPECT_NEAR(fit->function.threshold, threshold, 1e-6 * (1.0 + std::abs(threshold))) << data;
    EXPECT_NEAR(fit->function.slope, slope, 1e-6 * slope) << data;
    ++fits;
  }
  EXPECT_GT(fits, 800);
  EXPECT_GT(steps, 50);
  EXPECT_EQ(fits + steps + far, 1000);
}

TEST(Psychometric, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const test::WithoutTraps in_boost;
  const Psychometric observer{.threshold = 0.45, .slope = 9.0, .guess = 0.5, .lapse = 0.02};
  Random random(7);
  int threshold = 0, slope = 0, fits = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    const auto fit = fit_psychometric(simulate(observer, 15, 60, random), 0.5, 0.02);
    if (!fit || !fit->threshold || !fit->slope) continue;
    ++fits;
    const auto holds = [](const Interval& of, double x) { return of.low <= x && x <= of.high; };
    EXPECT_TRUE(holds(*fit->threshold, fit->function.threshold));
    EXPECT_TRUE(holds(*fit->slope, fit->function.slope));
    threshold += holds(*fit->threshold, observer.threshold) ? 1 : 0;
    slope += holds(*fit->slope, observer.slope) ? 1 : 0;
  }
  EXPECT_GE(fits, kRuns - 3);
  // 95 % with a standard error of 1.3 %
  EXPECT_NEAR(threshold, 0.95 * fits, 0.04 * fits);
  EXPECT_NEAR(slope, 0.95 * fits, 0.04 * fits);
}

// An end of the interval is where the likelihood ratio's test turns significant.
TEST(Psychometric, IntervalsEndWhereTheLikelihoodHasFallen) {
  const test::WithoutTraps in_boost;
  Random random(3);
  const Psychometric observer{.threshold = 0.5, .slope = 10.0, .guess = 0.5, .lapse = 0.0};
  const Scores scores = simulate(observer, 6, 50, random);
  const auto fit = fit_psychometric(scores, 0.5, 0.0);
  ASSERT_TRUE(fit && fit->threshold);
  const auto best_with = [&](double threshold) {
    double best = -HUGE_VAL;
    for (double s = std::log(0.5); s < std::log(500.0); s += 1e-3) {
      const Psychometric psi{threshold, std::exp(s), 0.5, 0.0};
      double sum = 0.0;
      for (const LevelScore& score : scores) {
        const double right = psi.at(score.level);
        sum += score.correct.successes * std::log(right) +
               (score.correct.trials - score.correct.successes) * std::log1p(-right);
      }
      best = std::max(best, sum);
    }
    return best;
  };
  for (const double end : {fit->threshold->low, fit->threshold->high})
    EXPECT_NEAR(fit->log_likelihood - best_with(end), 0.5 * 3.841459, 1e-4);
}

TEST(Psychometric, AnswersThatBoundNothingHaveNoFit) {
  const test::WithoutTraps in_boost;
  const auto why = [](const Scores& scores, double guess) {
    std::optional<NoFit> reason;
    NoFit given = NoFit::TooFewLevels;
    if (!fit_psychometric(scores, guess, 0.0, 0.95, &given)) reason = given;
    return reason;
  };
  EXPECT_EQ(why({{0.5, {3, 4}}}, 0.5), NoFit::TooFewLevels);
  EXPECT_EQ(why({{0.5, {3, 4}}, {0.5, {2, 4}}}, 0.5), NoFit::TooFewLevels);
  EXPECT_EQ(why({{0.2, {9, 9}}, {0.5, {9, 9}}}, 0.5), NoFit::NotGrowing);
  EXPECT_EQ(why({{0.2, {9, 9}}, {0.5, {0, 9}}}, 0.0), NoFit::NotGrowing);  // it falls
  EXPECT_EQ(why({{0.2, {0, 9}}, {0.5, {9, 9}}}, 0.0), NoFit::Step);
  EXPECT_EQ(why({{0.2, {4, 9}}, {0.5, {7, 9}}, {0.6, {9, 9}}}, 0.5), NoFit::Step);
  EXPECT_EQ(why({{0.2, {5, 9}}, {0.5, {7, 9}}, {0.6, {8, 9}}}, 0.5), std::nullopt);
}

TEST(Psychometric, IsHalfWayAtItsThreshold) {
  const Psychometric psi{.threshold = 0.3, .slope = 9.0, .guess = 0.25, .lapse = 0.05};
  EXPECT_NEAR(psi.at(0.3), 0.25 + 0.35, 1e-12);
  EXPECT_NEAR(psi.at(-1e6), 0.25, 1e-12);
  EXPECT_NEAR(psi.at(1e6), 0.95, 1e-12);
}

}  // namespace
}  // namespace prostm
