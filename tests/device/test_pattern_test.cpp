// The self-test's figures, as played by a simulated array.

#include "prostm/device/test_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "prostm/core/random.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/emit/emitter.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3, kHeight = 0.15;

/// Two AUTD3 units side by side.
TransducerArray two_units() {
  Pose left = Pose::Identity(), right = Pose::Identity();
  left.translation().x() = -0.1;
  right.translation().x() = 0.1;
  const std::vector<TransducerArray> units = {place(autd3_array(), left),
                                              place(autd3_array(), right)};
  return join(units);
}

/// Plays figures on a simulated array without a clock.
struct Played {
  explicit Played(std::vector<TestFigure> figures, double rate = kRate, double level = 1.0)
      : pattern(std::move(figures), rate, level) {
    SimulatedArraySettings settings;
    settings.realtime = false;
    settings.sample_rate = rate;
    settings.history = 60.0;
    device = std::make_unique<SimulatedArray>(settings, usx_array(), Medium{});
    chain = make_sample_chain(pattern, device->info(), {});
    device->start(*chain);
  }
  /// Pulls until the pattern is finished, and returns the samples played meanwhile.
  std::vector<FocusSample> until_done() {
    const std::int64_t first = device->samples();
    while (!pattern.done()) device->pull(1);
    return device->read_back(first, device->samples() - first);
  }
  std::vector<FocusSample> pull(int blocks) {
    const std::int64_t first = device->samples();
    device->pull(blocks);
    return device->read_back(first, device->samples() - first);
  }

  TestPattern pattern;
  std::unique_ptr<SimulatedArray> device;
  std::unique_ptr<SampleChain> chain;
};

/// Checks the steps between samples: of positions while the output is on, and of intensities.
void expect_steps(const std::vector<FocusSample>& samples, double rate) {
  const double step = kMaxFocusSpeed / rate * (1.0 + 1e-4), change = 0.025 * (1.0 + 1e-4);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const FocusSample &a = samples[i - 1], &b = samples[i];
    ASSERT_LE(std::abs(b.intensity - a.intensity), change) << i;
    if (a.intensity <= 0.01F || b.intensity <= 0.01F) continue;
    ASSERT_LE((b.p_D - a.p_D).norm(), step) << i;
  }
}

TEST(TestPattern, IsSilentUntilAFigureStarts) {
  Played played(test_figures(usx_array(), kRate, kHeight, 1.0));
  EXPECT_TRUE(played.pattern.done());
  for (const FocusSample& sample : played.pull(100)) ASSERT_EQ(sample.intensity, 0.0F);
}

TEST(TestPattern, PlaysEachFigureAtItsPlaceInSmallSteps) {
  const auto figures = test_figures(two_units(), kRate, kHeight, 1.0);
  ASSERT_EQ(figures.size(), 4U);
  Played played(figures);
  for (std::size_t f = 0; f < figures.size(); ++f) {
    played.pattern.play(f);
    EXPECT_FALSE(played.pattern.done());
    const std::vector<FocusSample> samples = played.until_done();
    ASSERT_NEAR(static_cast<double>(samples.size()), kRate, 41.0);
    expect_steps(samples, kRate);
    float largest = 0.0F;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      largest = std::max(largest, samples[i].intensity);
      const Vec3 at = figures[f].position(static_cast<double>(i) / kRate);
      ASSERT_LT((samples[i].p_D.cast<double>() - at).norm(), 1e-6) << i;
    }
    EXPECT_GT(largest, 0.99F);
    EXPECT_EQ(samples.back().intensity, 0.0F);
  }
  EXPECT_EQ(played.chain->limited(), 0);
}

TEST(TestPattern, FadesIn) {
  Played played(test_figures(usx_array(), kRate, kHeight, 4.0), kRate, 0.5);
  played.pattern.play(1);
  const std::vector<FocusSample> samples = played.until_done();
  EXPECT_LT(samples[4000].intensity, 0.5F * 0.25F);
  EXPECT_FLOAT_EQ(samples[100'000].intensity, 0.5F);
}

TEST(TestPattern, PlacesAFigureOverEachUnit) {
  const TransducerArray array = two_units();
  const auto figures = test_figures(array, kRate, kHeight, 1.0);
  EXPECT_LT((figures[2].centre - Vec3(-0.1, 0.0, kHeight)).norm(), 2e-3);
  EXPECT_LT((figures[3].centre - Vec3(0.1, 0.0, kHeight)).norm(), 2e-3);
  EXPECT_EQ(test_figures(usx_array(), kRate, kHeight, 1.0).size(), 2U);
}

TEST(TestPattern, IsSilentWithinTwoMillisecondsWithoutClicks) {
  Random random(7);
  Played played(test_figures(two_units(), kRate, kHeight, 1.0));
  std::vector<FocusSample> all;
  for (int i = 0; i < 300; ++i) {
    const auto figure = static_cast<std::size_t>(random.uniform(0.0, 3.999));
    played.pattern.play(figure);
    for (const auto& s : played.pull(1 + static_cast<int>(random.uniform(0.0, 40.0))))
      all.push_back(s);
    if (random.uniform(0.0, 1.0) < 0.5) continue;
    played.pattern.silence();
    for (const auto& s : played.pull(3)) all.push_back(s);
    EXPECT_TRUE(played.pattern.done());
    EXPECT_EQ(all.back().intensity, 0.0F);
  }
  expect_steps(all, kRate);
  EXPECT_EQ(played.chain->limited(), 0);
}

TEST(TestPattern, StaysWithinItsBoundsAtEveryRate) {
  for (const double rate : {4e3, 10e3, 20e3, 40e3, 100e3}) {
    const auto figures = test_figures(usx_array(), rate, kHeight, 0.5);
    Played played(figures, rate);
    for (std::size_t f = 0; f < figures.size(); ++f) {
      played.pattern.play(f);
      expect_steps(played.until_done(), rate);
    }
    EXPECT_EQ(played.chain->limited(), 0) << rate;
  }
}

TEST(TestPattern, DoesNotAllocateWhilePlaying) {
  TestPattern pattern(test_figures(usx_array(), kRate, kHeight, 1.0), kRate, 1.0);
  std::vector<FocusSample> block(400);
  const test::HeapGuard guard;
  pattern.play(1);
  for (int i = 0; i < 50; ++i) pattern.fill(400 * i, block);
  pattern.silence();
  pattern.fill(20'000, block);
  EXPECT_EQ(guard.allocations(), 0U);
  EXPECT_TRUE(pattern.done());
}

TEST(TestPattern, RejectsUnsafeFigures) {
  const auto refused = [](auto change) {
    TestFigure figure{"a circle", TestShape::Circle, Vec3(0, 0, 0.15), 0.02, 60.0, 0.0, 1.0};
    change(figure);
    EXPECT_THROW(TestPattern({figure}, kRate, 1.0), std::invalid_argument);
  };
  refused([](auto& f) { f.frequency = 64.0; });  // 8.04 m/s
  refused([](auto& f) { f.modulation = 201.0; });
  refused([](auto& f) { f.seconds = 0.05; });
  refused([](auto& f) { f.centre.x() = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_THROW(TestPattern({}, kRate, 1.0), std::invalid_argument);
  EXPECT_THROW(TestPattern(test_figures(usx_array(), kRate, kHeight, 1.0), kRate, 1.01),
               std::invalid_argument);
}

}  // namespace
}  // namespace prostm
