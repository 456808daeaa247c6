#include "prostm/study/task/staircase.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/input_errors.hpp"

namespace prostm {
namespace {

constexpr int kRuns = 1000;

/// Bias and spread of the results of runs, relative to the truth.
struct Found {
  double bias = 0.0, spread = 0.0;
};

template <class Run>
Found find(double truth, const Run& run) {
  std::vector<double> found;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kRuns; ++i) found.push_back(run(static_cast<std::uint64_t>(i)) / truth - 1.0);
  for (const double x : found) sum += x;
  for (const double x : found) squares += (x - sum / kRuns) * (x - sum / kRuns);
  const Found out{sum / kRuns, std::sqrt(squares / (kRuns - 1))};
  testing::Test::RecordProperty("bias", std::to_string(out.bias));
  testing::Test::RecordProperty("spread", std::to_string(out.spread));
  return out;
}

/// Lets an observer answer until a procedure is finished.
template <class Procedure>
double settle(Procedure procedure, const Psychometric& observer, std::uint64_t seed) {
  Random random(seed);
  for (int trial = 0; !procedure.is_done() && trial < 1000; ++trial)
    procedure.answer(random.uniform() < observer.at(procedure.level()));
  EXPECT_TRUE(procedure.is_done());
  return procedure.threshold();
}

TEST(Staircase, UpAndDownFindsItsTarget) {
  for (const double threshold : {0.3, 0.4, 0.6}) {
    const Psychometric observer{.threshold = threshold, .slope = 20.0, .guess = 0.5};
    const Found found = find(threshold, [&](std::uint64_t seed) {
      return settle(WeightedUpDown({.step = 0.02, .reversals = 22}), observer, seed);
    });
    EXPECT_LT(std::abs(found.bias), 0.05) << threshold;
    EXPECT_LT(found.spread, 0.2) << threshold;
  }
}

// Kaernbach's steps converge to the level where the target's share is right, for any target.
TEST(Staircase, UpAndDownConvergesWhereTheTargetsShareIsRight) {
  const Psychometric observer{.threshold = 0.5, .slope = 15.0, .guess = 0.0};
  for (const double target : {0.3, 0.5, 0.8}) {
    const double truth = 0.5 + std::log(target / (1.0 - target)) / 15.0;
    const Found found = find(truth, [&](std::uint64_t seed) {
      return settle(WeightedUpDown({.step = 0.02, .target = target, .coarse = 6, .reversals = 30}),
                    observer, seed);
    });
    EXPECT_LT(std::abs(found.bias), 0.05) << target;
  }
}

TEST(Staircase, BayesFindsTheThreshold) {
  for (const double threshold : {0.3, 0.4, 0.6}) {
    const Psychometric observer{.threshold = threshold, .slope = 20.0, .guess = 0.5, .lapse = 0.02};
    int held = 0;
    const Found found = find(threshold, [&](std::uint64_t seed) {
      Random random(seed);
      BayesianStaircase staircase({});
      while (!staircase.is_done())
        staircase.answer(random.uniform() < observer.at(staircase.level()));
      held += std::abs(staircase.threshold() - threshold) < 2.0 * staircase.deviation() ? 1 : 0;
      return staircase.threshold();
    });
    EXPECT_LT(std::abs(found.bias), 0.05) << threshold;
    EXPECT_LT(found.spread, 0.15) << threshold;
    EXPECT_NEAR(held, 0.95 * kRuns, 0.04 * kRuns) << threshold;
  }
}

/// Adjusts until both feel alike: perceives the difference with noise, steps against it, and
/// accepts once it is small.
double adjust(double truth, std::uint64_t seed) {
  Random random(seed);
  Adjustment adjustment({.seed = seed});
  while (!adjustment.is_done()) {
    const double felt = adjustment.level() - truth + 0.03 * random.normal();
    if (std::abs(felt) < 0.02) {
      adjustment.accept();
    } else {
      adjustment.tune(felt > 0.0 ? -1 : 1, std::abs(felt) > 0.1);
    }
  }
  return adjustment.result();
}

TEST(Staircase, AdjustmentFindsTheMatch) {
  for (const double truth : {0.3, 0.5, 0.7}) {
    const Found found = find(truth, [&](std::uint64_t seed) { return adjust(truth, seed); });
    EXPECT_LT(std::abs(found.bias), 0.05) << truth;
    EXPECT_LT(found.spread, 0.1) << truth;
  }
}

TEST(Staircase, AdjustmentStartsBelowAndAboveInTurn) {
  Adjustment adjustment({.repeats = 6, .seed = 4});
  EXPECT_TRUE(std::isnan(adjustment.result()));
  for (int repeat = 0; repeat < 6; ++repeat) {
    EXPECT_EQ(adjustment.level() < 0.5, repeat % 2 == 0);
    EXPECT_GE(std::abs(adjustment.level() - 0.5), 0.3);
    adjustment.accept();
  }
  EXPECT_TRUE(adjustment.is_done());
  adjustment.tune(1000, true);
  EXPECT_EQ(adjustment.level(), 1.0);
}

// A session that resumes after a crash replays the same answers.
TEST(Staircase, TheSameAnswersLeadToTheSameLevels) {
  WeightedUpDown a({}), b({});
  BayesianStaircase c({}), d({});
  Random random(1);
  for (int i = 0; i < 40; ++i) {
    const bool right = random.below(4) > 0;
    a.answer(right), b.answer(right), c.answer(right), d.answer(right);
    EXPECT_EQ(a.level(), b.level());
    EXPECT_EQ(c.level(), d.level());
  }
}

TEST(Staircase, LevelsStayInTheirRange) {
  EXPECT_TRUE(std::isnan(WeightedUpDown({}).threshold()));
  for (const bool right : {true, false}) {
    WeightedUpDown up_down({.start = 0.5, .range = {0.2, 0.9}});
    BayesianStaircase bayes({.range = {0.2, 0.9}});
    for (int i = 0; i < 500; ++i) {
      up_down.answer(right), bayes.answer(right);
      for (const double level : {up_down.level(), bayes.level()}) {
        EXPECT_GE(level, 0.2);
        EXPECT_LE(level, 0.9);
      }
      EXPECT_TRUE(std::isfinite(bayes.threshold()) && std::isfinite(bayes.deviation()));
    }
  }
}

TEST(Staircase, SettingsOutOfBoundsAreRejected) {
  EXPECT_THROW(WeightedUpDown({.start = 2.0}), std::invalid_argument);
  EXPECT_THROW(WeightedUpDown({.target = 1.0}), std::invalid_argument);
  EXPECT_THROW(WeightedUpDown({.coarse = 4, .reversals = 4}), std::invalid_argument);
  EXPECT_THROW(WeightedUpDown({.range = {1.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(BayesianStaircase({.trials = 0}), std::invalid_argument);
  EXPECT_THROW(BayesianStaircase({.spread = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(Adjustment({.coarse = 0.001}), std::invalid_argument);
  EXPECT_THROW(Adjustment({.away = 0.9}), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
