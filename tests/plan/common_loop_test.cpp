#include "prostm/plan/detail/fit/felt/common_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"

namespace prostm::planning {
namespace {

constexpr double kLongest = 20e-3;

TEST(CommonLoop, IsThatOfTheLongestPathIfAllAreEqual) {
  const std::vector<double> own(4, kLongest);
  const CommonLoop loop = choose_loop(own, kLongest, 0.0);
  EXPECT_DOUBLE_EQ(loop.period, kLongest);
  for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(loop.laps[k], 1);
}

TEST(CommonLoop, LetsShortPathsMakeMoreLaps) {
  const std::vector<double> own = {kLongest, kLongest / 2, kLongest / 4};
  const CommonLoop loop = choose_loop(own, kLongest, 0.0);
  EXPECT_DOUBLE_EQ(loop.period, kLongest);
  EXPECT_EQ(loop.laps[1], 2);
  EXPECT_EQ(loop.laps[2], 4);
  EXPECT_NEAR(loop.pace, 1.0, 1e-12);
}

TEST(CommonLoop, ReportsHowMuchItSlowsPathsDown) {
  const std::vector<double> own = {kLongest, 0.9 * kLongest, 0.4 * kLongest};
  const CommonLoop loop = loop_of(own, kLongest);
  EXPECT_NEAR(loop.pace, (1.0 + 0.9 + 2 * 0.4) / 3, 1e-12);
}

TEST(CommonLoop, IsShorterIfAllPathsAre) {
  const std::vector<double> own(3, 0.6 * kLongest);
  const CommonLoop loop = choose_loop(own, kLongest, 0.0);
  EXPECT_DOUBLE_EQ(loop.period, 0.6 * kLongest);
  // the last plan's loop is kept while that costs little
  const CommonLoop kept = choose_loop(own, kLongest, 0.62 * kLongest);
  EXPECT_DOUBLE_EQ(kept.period, 0.62 * kLongest);
  EXPECT_DOUBLE_EQ(choose_loop(own, kLongest, kLongest).period, 0.6 * kLongest);
}

TEST(CommonLoop, IsNeverTooFastAndNeverSlowerThanTheLongest) {
  Random random(5);
  for (int draw = 0; draw < 100'000; ++draw) {
    std::vector<double> own(static_cast<std::size_t>(1 + random.below(8)));
    for (double& lap : own) lap = kLongest * random.uniform(0.05, 1.0);
    const double before = draw % 3 == 0 ? 0.0 : kLongest * random.uniform(0.5, 1.0);
    const CommonLoop loop = choose_loop(own, kLongest, before);
    ASSERT_LE(loop.period, kLongest * (1.0 + 1e-12));
    ASSERT_GE(loop.period, 0.5 * kLongest);
    double quickness = 0.0, with_longest = 0.0;
    for (std::size_t k = 0; k < own.size(); ++k) {
      ASSERT_GE(loop.laps[k], 1);
      ASSERT_LE(loop.laps[k] * own[k], loop.period * (1.0 + 1e-8));
      quickness += std::pow(loop.laps[k] * own[k] / loop.period, 2);
      with_longest += std::pow(loop_of(own, kLongest).laps[k] * own[k] / kLongest, 2);
    }
    ASSERT_GE(1.1001 * quickness, with_longest);
  }
}

}  // namespace
}  // namespace prostm::planning
