#include "prostm/study/task/psychometric.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
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
    const auto fit = fit_psychometric(scores, {0.0, 0.0}).fit;
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

TEST(Psychometric, IntervalsContainTheTruthAsOftenAsStated) {
  const test::WithoutTraps in_boost;
  const Psychometric observer{.threshold = 0.45, .slope = 9.0, .guess = 0.5, .lapse = 0.02};
  Random random(7);
  int threshold = 0, slope = 0, fits = 0;
  constexpr int kRuns = 300;
  for (int run = 0; run < kRuns; ++run) {
    const auto fit = fit_psychometric(simulate(observer, 15, 60, random), {0.5, 0.02}).fit;
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

// An interval ends where the likelihood ratio test becomes significant.
TEST(Psychometric, IntervalsEndWhereTheLikelihoodHasDropped) {
  const test::WithoutTraps in_boost;
  Random random(3);
  const Psychometric observer{.threshold = 0.5, .slope = 10.0, .guess = 0.5, .lapse = 0.0};
  const Scores scores = simulate(observer, 6, 50, random);
  const auto fit = fit_psychometric(scores, {0.5, 0.0}).fit;
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

TEST(Psychometric, AnswersWithoutAFitHaveAReason) {
  const test::WithoutTraps in_boost;
  const auto why = [](const Scores& scores, double guess) {
    const PsychometricResult found = fit_psychometric(scores, {guess, 0.0});
    return found.fit ? std::nullopt : std::optional(found.no_fit);
  };
  EXPECT_EQ(why({{0.5, {3, 4}}}, 0.5), NoFit::TooFewLevels);
  EXPECT_EQ(why({{0.5, {3, 4}}, {0.5, {2, 4}}}, 0.5), NoFit::TooFewLevels);
  EXPECT_EQ(why({{0.2, {9, 9}}, {0.5, {9, 9}}}, 0.5), NoFit::BelowLevels);
  EXPECT_EQ(why({{0.2, {0, 9}}, {0.5, {0, 9}}}, 0.0), NoFit::AboveLevels);
  EXPECT_EQ(why({{0.2, {22, 30}}, {0.5, {22, 30}}}, 0.5), NoFit::NotGrowing);
  EXPECT_EQ(why({{0.2, {9, 9}}, {0.5, {0, 9}}}, 0.0), NoFit::Falling);
  EXPECT_EQ(why({{0.1, {19, 20}}, {0.2, {16, 20}}, {0.3, {11, 20}}}, 0.5), NoFit::Falling);
  EXPECT_EQ(why({{0.2, {0, 9}}, {0.5, {9, 9}}}, 0.0), NoFit::Step);
  EXPECT_EQ(why({{0.2, {4, 9}}, {0.5, {7, 9}}, {0.6, {9, 9}}}, 0.5), NoFit::Step);
  EXPECT_EQ(why({{0.2, {5, 9}}, {0.5, {7, 9}}, {0.6, {8, 9}}}, 0.5), std::nullopt);
}

// The ends of these intervals have a closed form: for a threshold beyond a level, a step is the
// best fit, and the answers at that level have the probability half-way, or that of the other
// side.
TEST(Psychometric, SeparatedAnswersBoundTheThreshold) {
  const test::WithoutTraps in_boost;
  const Scores scores = {{1.0, {0, 40}}, {2.0, {0, 40}}, {3.0, {40, 40}}, {4.0, {40, 40}}};
  const auto bounds = fit_psychometric(scores, {0.0, 0.02}).bounds;
  ASSERT_TRUE(bounds);
  EXPECT_EQ(bounds->best.low, 2.0);
  EXPECT_EQ(bounds->best.high, 3.0);
  // 40 answers at a level are too many to lie on the other side of the threshold
  EXPECT_NEAR(bounds->interval.low, 2.0, 0.05);
  EXPECT_NEAR(bounds->interval.high, 3.0, 0.05);
  // with 2 at a level, thresholds beyond them are still likely
  const auto few =
      fit_psychometric(Scores{{1.0, {0, 2}}, {2.0, {0, 2}}, {3.0, {2, 2}}, {4.0, {2, 2}}},
                       {0.0, 0.0})
          .bounds;
  ASSERT_TRUE(few);
  EXPECT_NEAR(few->interval.low, 1.8937460, 1e-5);  // from a dense grid of slopes
  EXPECT_NEAR(few->interval.high, 3.1062540, 1e-5);
}

TEST(Psychometric, AnswersBeyondTheLevelsAreCensored) {
  const test::WithoutTraps in_boost;
  const auto all = fit_psychometric(Scores{{1.0, {30, 30}}, {1.5, {10, 10}}}, {0.0, 0.02});
  ASSERT_TRUE(all.bounds);
  EXPECT_EQ(all.no_fit, NoFit::BelowLevels);
  EXPECT_TRUE(std::isinf(all.bounds->interval.low));
  EXPECT_EQ(all.bounds->best.high, 1.0);
  EXPECT_NEAR(all.bounds->interval.high, 1.0, 0.01);
  const auto none = fit_psychometric(Scores{{1.0, {5, 10}}, {1.5, {14, 30}}}, {0.5, 0.02});
  ASSERT_TRUE(none.bounds);
  EXPECT_EQ(none.no_fit, NoFit::AboveLevels);
  EXPECT_TRUE(std::isinf(none.bounds->interval.high));
  // one level: 2 n log(0.98 / 0.49) is above 3.8415 from n = 3 on
  EXPECT_TRUE(fit_psychometric(Scores{{1.0, {3, 3}}}, {0.0, 0.02}).bounds);
  EXPECT_FALSE(fit_psychometric(Scores{{1.0, {2, 2}}}, {0.0, 0.02}).bounds);
}

// The numbers are from scipy (optimize.minimize over threshold, slope and lapse rate; brentq on the
// profile likelihood; 1000 fits to answers drawn from the function).
TEST(Psychometric, FittedLapsesAndMisfitAgreeWithScipy) {
  const test::WithoutTraps in_boost;
  const std::array<int, 8> right = {26, 24, 33, 40, 43, 42, 45, 44};
  Scores scores;
  for (std::size_t i = 0; i < right.size(); ++i)
    scores.push_back({0.1 * static_cast<double>(i + 1), {right[i], 50}});
  const auto free = fit_psychometric(scores, {.guess = 0.5, .lapse = std::nullopt}).fit;
  ASSERT_TRUE(free && free->threshold && free->misfit);
  EXPECT_NEAR(free->function.threshold, 0.3243469, 1e-6);
  EXPECT_NEAR(free->function.slope, 20.761956, 1e-4);
  EXPECT_NEAR(free->function.lapse, 0.1278039, 1e-6);
  EXPECT_NEAR(free->log_likelihood, -203.8369916, 1e-6);
  EXPECT_NEAR(free->threshold->low, 0.2625269, 1e-5);
  EXPECT_NEAR(free->threshold->high, 0.3973074, 1e-5);
  EXPECT_NEAR(free->misfit->deviance, 1.3966667, 1e-6);
  EXPECT_EQ(free->misfit->df, 5);
  const auto fixed = fit_psychometric(scores, {.guess = 0.5, .lapse = 0.02}).fit;
  ASSERT_TRUE(fixed && fixed->misfit);
  EXPECT_NEAR(fixed->function.threshold, 0.4245831, 1e-6);
  EXPECT_NEAR(fixed->misfit->deviance, 8.3416771, 1e-6);
  EXPECT_NEAR(fixed->misfit->p, 0.218, 0.15);  // from the first ten that deviate as much
}

// Intervals of censored results contain the truth: few levels, all below or above the threshold.
TEST(Psychometric, BoundsContainTheTruth) {
  const test::WithoutTraps in_boost;
  Random random(11);
  constexpr int kRuns = 300;
  int holds = 0, all = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Psychometric observer{2.0 * random.uniform() - 0.5, 30.0, 0.5, 0.02};
    const auto found = fit_psychometric(simulate(observer, 4, 12, random), {0.5, 0.02});
    if (!found.bounds) continue;
    ++all;
    holds += found.bounds->interval.low <= observer.threshold &&
             observer.threshold <= found.bounds->interval.high;
  }
  EXPECT_GT(all, 100);
  EXPECT_GE(holds, 0.93 * all);
}

TEST(Psychometric, MisfitIsAsRareAsStatedAndFindsLapses) {
  const test::WithoutTraps in_boost;
  Random random(5);
  const Psychometric good{0.5, 12.0, 0.5, 0.02}, lapsing{0.4, 25.0, 0.5, 0.2};
  int rare = 0, found = 0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const auto fit = fit_psychometric(simulate(good, 9, 40, random), {0.5, 0.02}).fit;
    if (fit && fit->misfit && fit->misfit->p < 0.05) ++rare;
    const auto other = fit_psychometric(simulate(lapsing, 9, 150, random), {0.5, 0.02}).fit;
    if (other && other->misfit && other->misfit->p < 0.05) ++found;
  }
  EXPECT_LE(rare, 0.12 * kRuns);  // 5 % with a standard error of 2.2 %
  EXPECT_GT(found, 0.6 * kRuns);
}

TEST(Psychometric, IsHalfWayAtItsThreshold) {
  const Psychometric psi{.threshold = 0.3, .slope = 9.0, .guess = 0.25, .lapse = 0.05};
  EXPECT_NEAR(psi.at(0.3), 0.25 + 0.35, 1e-12);
  EXPECT_NEAR(psi.at(-1e6), 0.25, 1e-12);
  EXPECT_NEAR(psi.at(1e6), 0.95, 1e-12);
}

}  // namespace
}  // namespace prostm
