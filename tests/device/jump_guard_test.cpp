#include "prostm/device/detail/jump_guard.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/heap_guard.hpp"

namespace prostm {
namespace {

/// Intensities that pass when a focal point goes to these places [mm] along x.
std::vector<float> passed(const std::vector<float>& places) {
  JumpGuard guard;
  guard.reset(1, 0.8e-3);
  std::vector<float> intensities;
  for (const float x : places) {
    std::array<FocusSample, 1> sample{FocusSample{{1e-3F * x, 0.0F, 0.2F}, 0.5F}};
    guard.apply(sample);
    intensities.push_back(sample[0].intensity);
  }
  return intensities;
}

using Floats = std::vector<float>;

TEST(JumpGuard, SilencesTheSampleAfterAJump) {
  EXPECT_EQ(passed({0.0F, 0.7F, 1.4F, 50.0F, 50.7F}), (Floats{0.0F, 0.5F, 0.5F, 0.0F, 0.5F}));
}

TEST(JumpGuard, LetsFastPathsSound) {
  EXPECT_EQ(passed({0.0F, 1.5F, 3.0F, 4.5F}), (Floats{0.0F, 0.0F, 0.5F, 0.5F}));
}

TEST(JumpGuard, SilencesJumpsInARow) {
  EXPECT_EQ(passed({0.0F, 50.0F, 0.0F, 40.0F, 40.5F}), (Floats{0.0F, 0.0F, 0.0F, 0.0F, 0.5F}));
}

TEST(JumpGuard, SilencesPlacesThatAreNotNumbers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(passed({0.0F, nan, 0.1F, 0.2F}), (Floats{0.0F, 0.0F, 0.0F, 0.5F}));
}

TEST(JumpGuard, AllocatesNothing) {
  JumpGuard guard;
  guard.reset(8, 1e-3);
  std::array<FocusSample, 8> sample;
  const test::HeapGuard heap;
  for (int i = 0; i < 100; ++i) guard.apply(sample);
  EXPECT_EQ(heap.allocations(), 0U);
}

}  // namespace
}  // namespace prostm
