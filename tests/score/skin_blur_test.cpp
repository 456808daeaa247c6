#include "prostm/score/detail/skin_blur.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/score/pooled.hpp"
#include "support/only_targets.hpp"

namespace prostm {
namespace {

TargetField random_target(Random& random) {
  TargetField target;
  target.resize(1 + random.below(150), 1 + random.below(90));
  target.cell = 0.3e-3 * std::pow(100.0, random.uniform());
  for (std::size_t i = 0; i < target.size(); ++i) {
    target.skin[i] = random.uniform() < 0.7 ? 1 : 0;
    target.pressure[i] = target.skin[i] != 0 ? random.uniform() : 0.0;
  }
  target.skin[0] = 1;
  target.pressure[0] = 1.0;
  return target;
}

/// Computes (Q5) by its definition at one cell: a mean over the skin of a square of 4 b around it.
double blurred_at(const TargetField& target, const std::vector<double>& field, int row, int col) {
  constexpr double kB = 8.5e-3;
  const int reach = static_cast<int>(4.0 * kB / target.cell);
  double sum = 0.0, weights = 0.0;
  for (int j = std::max(0, row - reach); j <= std::min(target.rows - 1, row + reach); ++j) {
    for (int i = std::max(0, col - reach); i <= std::min(target.cols - 1, col + reach); ++i) {
      const std::size_t cell = target.index(j, i);
      if (target.skin[cell] == 0) continue;
      const double d = std::hypot(j - row, i - col) * target.cell / kB;
      sum += std::exp(-0.5 * d * d) * field[cell];
      weights += std::exp(-0.5 * d * d);
    }
  }
  return sum / weights;
}

TEST(SkinBlur, AgreesWithItsDefinition) {
  Random random(5);
  WorkerPool pool(2);
  for (int trial = 0; trial < 30; ++trial) {
    const TargetField target = random_target(random);
    std::vector<double> field(target.size());
    for (double& p : field) p = random.uniform();
    const std::vector<double> alone = SkinBlur(target).of(field);
    EXPECT_EQ(SkinBlur(target, &pool).of(field), alone);
    for (int draw = 0; draw < 20; ++draw) {
      const int row = random.below(target.rows), col = random.below(target.cols);
      const std::size_t cell = target.index(row, col);
      const double expected = target.skin[cell] != 0 ? blurred_at(target, field, row, col) : 0.0;
      EXPECT_NEAR(alone[cell], expected, 1e-12);
    }
  }
}

TEST(SkinBlur, IsTheSameOnEveryVectorTarget) {
  Random random(7);
  for (int trial = 0; trial < 5; ++trial) {
    const TargetField target = random_target(random);
    std::vector<double> field(target.size());
    for (double& p : field) p = random.uniform();
    const std::vector<double> expected = SkinBlur(target).of(field);
    for (const std::int64_t vectors : hwy::SupportedAndGeneratedTargets()) {
      const test::OnlyTargets only(vectors);
      const std::vector<double> found = SkinBlur(target).of(field);
      for (std::size_t i = 0; i < field.size(); ++i)
        ASSERT_NEAR(found[i], expected[i], 1e-14) << hwy::TargetName(vectors);
    }
  }
}

TEST(Controls, DoNotDependOnTheNumberOfThreads) {
  Random random(6);
  WorkerPool pool(3);
  for (int trial = 0; trial < 4; ++trial) {
    const TargetField target = random_target(random);
    const GainLaw gain{1.4};
    const auto alone = controls(target, 8.6e-3, gain, 0.14, nullptr, 1),
               shared = controls(target, 8.6e-3, gain, 0.14, nullptr, 1, {}, pool);
    ASSERT_EQ(alone.size(), shared.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ(alone[i].metrics.skill_8, shared[i].metrics.skill_8);
      EXPECT_EQ(alone[i].metrics.rmse, shared[i].metrics.rmse);
      EXPECT_EQ(alone[i].metrics.coverage, shared[i].metrics.coverage);
    }
  }
}

}  // namespace
}  // namespace prostm
