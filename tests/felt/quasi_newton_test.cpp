#include "prostm/felt/quasi_newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

TEST(QuasiNewton, FindsTheMinimumOfAQuadraticForm) {
  Random random(3);
  QuasiNewton descent(64);
  for (int draw = 0; draw < 500; ++draw) {
    const auto n = static_cast<std::size_t>(1 + random.below(64));
    std::vector<float> curvature, middle, x;
    for (std::size_t i = 0; i < n; ++i) {
      curvature.push_back(static_cast<float>(random.uniform(0.2, 5.0)));
      middle.push_back(static_cast<float>(random.normal()));
      x.push_back(static_cast<float>(random.normal()));
    }
    const auto cost = [&](std::span<const float> at, std::span<float> gradient) {
      float sum = 0.0F;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const float off = at[i] - middle[i];
        gradient[i] = curvature[i] * off;
        sum += 0.5F * curvature[i] * off * off;
      }
      return sum;
    };
    descent.begin(cost, x);
    EXPECT_LE(descent.run(cost, 0.1F, 80, x), 80);
    for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(x[i], middle[i], 1e-2F);
  }
}

TEST(QuasiNewton, NeverEndsHigherAndKeepsToItsCount) {
  Random random(4);
  QuasiNewton descent(8);
  for (int draw = 0; draw < 20'000; ++draw) {
    std::vector<float> x(4), wave(4);
    for (std::size_t i = 0; i < 4; ++i) {
      x[i] = static_cast<float>(random.uniform(-3.0, 3.0));
      wave[i] = static_cast<float>(random.uniform(0.5, 3.0));
    }
    int calls = 0;
    const auto cost = [&](std::span<const float> at, std::span<float> gradient) {
      ++calls;
      float sum = 0.0F;
      for (std::size_t i = 0; i < at.size(); ++i) {
        sum += std::sin(wave[i] * at[i]) + 0.05F * at[i] * at[i];
        gradient[i] = wave[i] * std::cos(wave[i] * at[i]) + 0.1F * at[i];
      }
      return sum;
    };
    std::vector<float> gradient(4);
    const float before = cost(x, gradient);
    calls = 0;
    const int most = 1 + random.below(12);
    descent.begin(cost, x);
    const int used = descent.run(cost, 0.5F, most, x);
    ASSERT_EQ(used, calls);
    ASSERT_LE(used, most);
    ASSERT_LE(descent.lowest(), before);
    ASSERT_FLOAT_EQ(descent.lowest(), cost(x, gradient));
  }
}

TEST(QuasiNewton, StaysWithoutAGradientAndDoesNotAllocate) {
  QuasiNewton descent(4);
  std::vector<float> x = {1.0F, 2.0F};
  const QuasiNewton::Cost flat = [](std::span<const float>, std::span<float> gradient) {
    std::fill(gradient.begin(), gradient.end(), 0.0F);
    return 3.0F;
  };
  const test::HeapGuard guard;
  EXPECT_EQ(descent.begin(flat, x), 3.0F);
  EXPECT_EQ(descent.run(flat, 0.5F, 10, x), 1);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_EQ(x, (std::vector<float>{1.0F, 2.0F}));
}

}  // namespace
}  // namespace prostm
