#include "prostm/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace prostm {
namespace {

// ISO C++ [rand.predef]: the 10000th value of mt19937_64 with its default seed 5489 is
// 9981545732273789042.
TEST(Random, IsTheStandardsMersenneTwister) {
  Random random(5489);
  std::uint64_t value = 0;
  for (int i = 0; i < 10000; ++i) value = random.bits();
  EXPECT_EQ(value, 9981545732273789042u);
}

TEST(Random, FirstValuesOfTheDefaultSeed) {
  Random random(5489);
  EXPECT_EQ(random.bits(), 14514284786278117030u);
  EXPECT_EQ(random.bits(), 4620546740167642908u);
  EXPECT_EQ(random.bits(), 13109570281517897720u);
}

TEST(Random, SameSeedSameNumbers) {
  Random a(42), b(42), c(43);
  int different = 0;
  for (int i = 0; i < 100; ++i) {
    const double x = a.normal();
    EXPECT_EQ(x, b.normal());
    different += x != c.normal();
  }
  EXPECT_GT(different, 90);
}

TEST(Random, UniformUsesTheUpperBits) {
  Random numbers(6), bits(6);
  for (int i = 0; i < 1000; ++i) {
    const double u = numbers.uniform();
    EXPECT_EQ(u, std::ldexp(static_cast<double>(bits.bits() >> 11), -53));
    EXPECT_GE(u, 0.0);
    EXPECT_LT(u, 1.0);
  }
}

// Moments within five standard errors of n = 200 000 draws.
TEST(Random, MomentsOfUniform) {
  Random random(7);
  const int n = 200000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double u = random.uniform(-1.0, 3.0);
    sum += u;
    squares += (u - 1.0) * (u - 1.0);
  }
  EXPECT_NEAR(sum / n, 1.0, 5.0 * std::sqrt(16.0 / 12.0 / n));
  EXPECT_NEAR(squares / n, 16.0 / 12.0, 5.0 * 4.0 * std::sqrt(4.0 / 45.0 / n));
}

TEST(Random, MomentsOfNormal) {
  Random random(8);
  const int n = 200000;
  std::array<double, 5> moment{};
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    for (std::size_t k = 1; k <= 4; ++k) moment[k] += std::pow(x, static_cast<double>(k)) / n;
  }
  // variances of x, x², x³, x⁴: 1, 2, 15, 96
  EXPECT_NEAR(moment[1], 0.0, 5.0 * std::sqrt(1.0 / n));
  EXPECT_NEAR(moment[2], 1.0, 5.0 * std::sqrt(2.0 / n));
  EXPECT_NEAR(moment[3], 0.0, 5.0 * std::sqrt(15.0 / n));
  EXPECT_NEAR(moment[4], 3.0, 5.0 * std::sqrt(96.0 / n));
}

TEST(Random, ShuffleGivesEveryOrderEquallyOften) {
  Random random(9);
  std::map<std::vector<int>, int> counts;
  constexpr int kDraws = 24000;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<int> values = {0, 1, 2, 3};
    random.shuffle(values);
    ++counts[values];
  }
  EXPECT_EQ(counts.size(), 24U);
  // 1000 each with a standard deviation of 31
  for (const auto& [values, count] : counts) EXPECT_NEAR(count, kDraws / 24, 160);
  std::vector<int> one = {5}, none;
  random.shuffle(one);
  random.shuffle(none);
  EXPECT_EQ(one, std::vector<int>{5});
}

TEST(Random, BelowCoversItsRangeEvenly) {
  Random random(9);
  const int n = 70000;
  std::array<int, 7> counts{};
  for (int i = 0; i < n; ++i) {
    const int k = random.below(7);
    ASSERT_GE(k, 0);
    ASSERT_LT(k, 7);
    ++counts[static_cast<std::size_t>(k)];
  }
  for (int count : counts) EXPECT_NEAR(count, n / 7.0, 5.0 * std::sqrt(n * 6.0 / 49.0));
  EXPECT_EQ(Random(10).below(1), 0);
}

}  // namespace
}  // namespace prostm
