#include "prostm/emit/loop_samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "emit/paths.hpp"
#include "prostm/core/random.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3;  // [Hz]

EmitSettings settings() {
  EmitSettings s;
  s.full_scale_pressure = 1.0;
  return s;
}

/// Returns rings of these lengths whose pressure ranges from 0.4 to 1.
LiftedPlan rings(const std::vector<double>& lengths) {
  LiftedPlan plan;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    plan.paths.push_back(
        test::ring(Vec3(0.05 * static_cast<double>(i), 0.0, 0.2), lengths[i], 40, 1.0));
    LiftedPath& path = plan.paths.back();
    for (std::size_t j = 0; j < path.pressure.size(); ++j) {
      path.pressure[j] = 0.7 + 0.3 * std::cos(2.0 * kPi * static_cast<double>(j) / 40.0);
    }
  }
  return plan;
}

// 140 mm at 7 m/s take exactly 800 samples: nothing is adjusted, and the emitter gives the same.
TEST(LoopSamples, MatchesTheRunningEmitter) {
  const LiftedPlan plan = rings({0.140, 0.070});
  const LoopSamples loop = loop_samples(plan, settings(), kRate);
  ASSERT_EQ(loop.samples, 800);
  EXPECT_EQ(loop.laps, (std::vector<int>{1, 2}));
  EXPECT_LT(loop.largest_stretch(), 1e-9);
  EmitSettings emit = settings();
  emit.foci = 2;
  PathEmitter emitter(emit, kRate);
  emitter.draft() = plan;
  emitter.submit();
  std::vector<FocusSample> block(2 * 2400);
  emitter.fill(0, block);
  // both start at the sample after the silent sample of the jump
  std::size_t offset = 0;
  double nearest = 1.0;
  for (std::size_t shift = 0; shift < 800; ++shift) {
    const double d =
        static_cast<double>((block[2 * (1600 + shift)].p_D - loop.sample[0].p_D).norm());
    if (d < nearest) {
      nearest = d;
      offset = shift;
    }
  }
  for (std::size_t k = 0; k < 800; ++k) {
    for (std::size_t f = 0; f < 2; ++f) {
      const FocusSample& ours = loop.sample[2 * k + f];
      const FocusSample& theirs = block[2 * (800 + (offset + k) % 800) + f];
      EXPECT_LT((ours.p_D - theirs.p_D).norm(), 1e-6F);
      EXPECT_NEAR(ours.intensity, theirs.intensity, 1e-6F);
    }
  }
}

TEST(LoopSamples, EveryPathClosesWithLittleAdjustment) {
  Random random(5);
  double worst = 0.0;
  for (int round = 0; round < 100; ++round) {
    std::vector<double> lengths;
    for (int i = 0; i < 4; ++i) lengths.push_back(random.uniform(0.035, 0.140));
    const LiftedPlan plan = rings(lengths);
    const LoopSamples loop = loop_samples(plan, settings(), kRate);
    EXPECT_EQ(loop.samples % kLoopUnit, 0);
    worst = std::max(worst, loop.largest_stretch());
    for (std::size_t f = 0; f < 4; ++f) {
      const double lap = lengths[f] / 7.0 * kRate;
      EXPECT_NEAR(loop.samples / (loop.laps[f] * lap) - 1.0, loop.stretch[f], 1e-9);
      // the step across the seam equals the other steps
      const std::size_t last = 4 * static_cast<std::size_t>(loop.samples - 1);
      const float seam = (loop.sample[f].p_D - loop.sample[last + f].p_D).norm();
      EXPECT_NEAR(seam, lengths[f] * loop.laps[f] / loop.samples, 1e-5);
      EXPECT_LE(std::abs(loop.sample[f].intensity - loop.sample[last + f].intensity),
                1.0F / 40.0F + 1e-6F);
    }
  }
  EXPECT_LT(worst, 0.05);
}

TEST(LoopSamples, KeepsThePowerLimitAndPathsAtRest) {
  LiftedPlan plan = rings({0.100});
  plan.paths.push_back(test::point(Vec3(0.0, 0.05, 0.2), 1.0));
  EmitSettings s = settings();
  s.power_limit = 0.5;
  const LoopSamples loop = loop_samples(plan, s, kRate);
  EXPECT_EQ(loop.laps[1], 0);
  for (int k = 0; k < loop.samples; ++k) {
    const FocusSample* at = &loop.sample[2 * static_cast<std::size_t>(k)];
    EXPECT_LE(at[0].intensity * at[0].intensity + at[1].intensity * at[1].intensity, 0.5F + 1e-6F);
    EXPECT_EQ(at[1].p_D, Eigen::Vector3f(0.0F, 0.05F, 0.2F));
  }
}

TEST(LoopSamples, RejectsPlansWithoutALoop) {
  EXPECT_THROW(loop_samples({}, settings(), kRate), std::invalid_argument);
  EXPECT_THROW(loop_samples(rings({0.1, 0.1, 0.1, 0.1, 0.1}), settings(), kRate),
               std::invalid_argument);
  LiftedPlan slow = rings({0.140});
  slow.paths[0].speed = 0.1;
  EXPECT_THROW(loop_samples(slow, settings(), kRate), std::invalid_argument);
  EXPECT_THROW(loop_samples(rings({0.1}), EmitSettings(), kRate), std::invalid_argument);
}

TEST(LoopSamples, APlanInStepHasItsOwnLoop) {
  LiftedPlan plan = rings({0.140, 0.050, 0.030});
  plan.loop = 20e-3;
  const std::vector<int> laps = {1, 2, 3};  // 800 is not a multiple of three laps
  for (std::size_t f = 0; f < 3; ++f) {
    plan.paths[f].speed = plan.paths[f].length * laps[f] / plan.loop;
  }
  const LoopSamples loop = loop_samples(plan, settings(), kRate);
  ASSERT_EQ(loop.samples, 800);
  EXPECT_EQ(loop.laps, laps);
  EXPECT_EQ(loop.largest_stretch(), 0.0);
  EXPECT_NEAR(longest_lap(plan), 20e-3, 1e-12);
  // sample by sample, the emitter's output in its second loop
  EmitSettings emit = settings();
  emit.foci = 3;
  PathEmitter emitter(emit, kRate);
  emitter.draft() = plan;
  emitter.submit();
  std::vector<FocusSample> block(3 * 1600);
  emitter.fill(0, block);
  for (std::size_t i = 0; i < loop.sample.size(); ++i) {
    const FocusSample& theirs = block[3 * 800 + i];
    ASSERT_LT((loop.sample[i].p_D - theirs.p_D).norm(), 1e-7F) << i;
    ASSERT_NEAR(loop.sample[i].intensity, theirs.intensity, 1e-6F) << i;
  }
  // a loop that is not a multiple of the unit is stretched for all paths alike
  plan.loop = 801.0 / kRate;
  const LoopSamples rounded = loop_samples(plan, settings(), kRate);
  EXPECT_EQ(rounded.samples, 800);
  for (const double stretch : rounded.stretch) EXPECT_NEAR(stretch, -1.0 / 801.0, 1e-12);
  // a path too long for one loop takes two, and the others make twice as many laps
  plan.loop = 10e-3;
  plan.paths[1].speed = 5.0;
  plan.paths.pop_back();
  const LoopSamples twice = loop_samples(plan, settings(), kRate);
  EXPECT_EQ(twice.samples, 800);
  EXPECT_EQ(twice.laps, (std::vector<int>{1, 2}));
  plan.loop = 2.0;
  EXPECT_THROW(loop_samples(plan, settings(), kRate), std::invalid_argument);
}

TEST(LoopSamples, FociGiveWholePeriodsOfTheirModulation) {
  LiftedPlan plan;
  plan.foci.push_back({Vec3(0.01, 0.0, 0.2), 1.0});
  plan.foci.push_back({Vec3(-0.03, 0.02, 0.19), 0.25});
  EmitSettings s = settings();
  LoopSamples loop = loop_samples(plan, s, kRate);
  EXPECT_EQ(loop.foci, 2);
  ASSERT_EQ(loop.samples, 200);
  EXPECT_EQ(loop.laps, (std::vector<int>{0, 0}));
  EXPECT_EQ(loop.largest_stretch(), 0.0);
  for (std::size_t k = 0; k < 200; ++k) {
    double sum = 0.0;
    for (std::size_t f = 0; f < 2; ++f) {
      EXPECT_EQ(loop.sample[2 * k + f].p_D, loop.sample[f].p_D);
      sum += std::pow(static_cast<double>(loop.sample[2 * k + f].intensity), 2);
    }
    EXPECT_NEAR(sum, 1.25 * std::pow(std::sin(kPi * static_cast<double>(k) / 200.0), 2), 1e-6);
  }
  // periods of 211 and 1600 samples; the first is not a multiple of the unit
  s.am_frequency = 190.0;
  EXPECT_EQ(loop_samples(plan, s, kRate).samples, 8 * 211);
  s.am_frequency = 25.0;
  loop = loop_samples(plan, s, kRate);
  EXPECT_EQ(loop.samples, 1600);
  EXPECT_GT(loop.sample[2 * 1590].intensity + loop.sample[2 * 1590 + 1].intensity, 0.0F);

  s.foci = 1;
  EXPECT_THROW(loop_samples(plan, s, kRate), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
