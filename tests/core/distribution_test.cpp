#include "prostm/core/distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

// The nearest-rank quantile by definition: the smallest value that is at least as large as a share
// q of the values.
double by_definition(const std::vector<double>& values, double q) {
  double best = 0.0;
  bool found = false;
  for (double candidate : values) {
    const auto not_above =
        std::count_if(values.begin(), values.end(), [&](double v) { return v <= candidate; });
    const bool enough = static_cast<double>(not_above) >= q * static_cast<double>(values.size());
    if (enough && (!found || candidate < best)) best = candidate, found = true;
  }
  return best;
}

void expect_exact_moments(const Summary& s, const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double squares = 0.0;
  for (double v : values) squares += (v - mean) * (v - mean);
  EXPECT_EQ(s.n, values.size());
  EXPECT_NEAR(s.mean, mean, 1e-12 * (1.0 + std::abs(mean)));
  EXPECT_NEAR(s.deviation, std::sqrt(squares / n), 1e-10 * (1.0 + std::sqrt(squares / n)));
  EXPECT_EQ(s.max, *std::max_element(values.begin(), values.end()));
}

TEST(Quantile, UsesTheNearestRank) {
  EXPECT_EQ(quantile({}, 0.5), 0.0);
  EXPECT_EQ(quantile({3.0}, 0.0), 3.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 0.51), 3.0);
  EXPECT_EQ(quantile({4.0, 1.0, 3.0, 2.0}, 1.0), 4.0);
}

TEST(Distribution, EmptyGivesZeros) {
  const Summary s = Distribution().summary();
  EXPECT_EQ(s.n, 0u);
  EXPECT_EQ(s.mean, 0.0);
  EXPECT_EQ(s.deviation, 0.0);
  EXPECT_EQ(s.p50, 0.0);
  EXPECT_EQ(s.p99, 0.0);
  EXPECT_EQ(s.max, 0.0);
}

TEST(Distribution, AgreesWithTheDefinitions) {
  Random random(3);
  for (int n : {1, 2, 3, 99, 100, 101, 777}) {
    Distribution distribution(1000);
    std::vector<double> values;
    for (int i = 0; i < n; ++i) {
      values.push_back(random.below(4) == 0 ? std::floor(random.uniform(-3.0, 3.0))
                                            : random.normal() - 1.0);
      distribution.add(values.back());
    }
    const Summary s = distribution.summary();
    expect_exact_moments(s, values);
    EXPECT_EQ(s.p50, by_definition(values, 0.50));
    EXPECT_EQ(s.p99, by_definition(values, 0.99));
  }
}

TEST(Distribution, MaximumOfNegativeValues) {
  Distribution distribution;
  distribution.add(-5.0);
  distribution.add(-2.0);
  EXPECT_EQ(distribution.summary().max, -2.0);
}

// Beyond its capacity the moments stay exact; the quantiles are those of values 0, s, 2s, …, where
// s is the smallest sufficient power of two.
TEST(Distribution, ThinsEvenlyWhenFull) {
  Random random(4);
  for (std::size_t capacity : {2, 3, 7, 8, 100}) {
    for (std::size_t n :
         {capacity, capacity + 1, 2 * capacity, 2 * capacity + 1, 37 * capacity + 5}) {
      Distribution distribution(capacity);
      std::vector<double> values;
      for (std::size_t i = 0; i < n; ++i) {
        values.push_back(random.uniform());
        distribution.add(values.back());
      }
      std::size_t stride = 1;
      while ((n + stride - 1) / stride > capacity) stride *= 2;
      std::vector<double> sample;
      for (std::size_t i = 0; i < n; i += stride) sample.push_back(values[i]);

      const Summary s = distribution.summary();
      expect_exact_moments(s, values);
      EXPECT_EQ(s.p50, by_definition(sample, 0.50)) << capacity << " " << n;
      EXPECT_EQ(s.p99, by_definition(sample, 0.99)) << capacity << " " << n;
    }
  }
}

TEST(Distribution, AddDoesNotAllocate) {
  Distribution distribution(64);
  const test::HeapGuard guard;
  for (int i = 0; i < 10000; ++i) distribution.add(i);
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(distribution.count(), 10000u);
}

}  // namespace
}  // namespace prostm
