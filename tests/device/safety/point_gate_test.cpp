#include "prostm/device/safety/detail/point_gate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr int kFade = 16;         // samples
constexpr double kLeast = 10e-3;  // [m]
constexpr PointGate::Bounds kBounds = {.least_separation = kLeast, .fade = kFade};

FocusSample focus(double x, double intensity) {
  return {Eigen::Vector3f(static_cast<float>(x), 0.0F, 0.2F), static_cast<float>(intensity)};
}

TEST(PointGate, DelaysPointsThatAreFarEnoughApart) {
  PointGate gate;
  gate.configure(2, kBounds);
  EXPECT_EQ(gate.delay(), kFade);
  std::vector<FocusSample> out(2);
  for (int i = 0; i < 200; ++i) {
    gate.step(std::vector{focus(1e-4 * i, 0.5), focus(-0.02, 0.25 + 0.001 * i)}, out);
    if (i < kFade) continue;
    ASSERT_EQ(out[0].p_D.x(), static_cast<float>(1e-4 * (i - kFade)));
    ASSERT_EQ(out[0].intensity, 0.5F);
    ASSERT_EQ(out[1].intensity, static_cast<float>(0.25 + 0.001 * (i - kFade)));
  }
  EXPECT_EQ(gate.weakened(), 0);
}

TEST(PointGate, MutesAPointAroundASampleThatIsNotFinite) {
  PointGate gate;
  gate.configure(1, kBounds);
  std::vector<FocusSample> out(1);
  for (int i = 0; i < 200; ++i) {
    gate.step(std::vector{focus(0.01, i == 100 ? std::nan("") : 0.5)}, out);
    if (i < kFade) continue;
    const int from_it = std::abs(i - kFade - 100);
    ASSERT_NEAR(static_cast<double>(out[0].intensity), 0.5 * std::min(1.0, from_it / 16.0), 1e-6);
    ASSERT_EQ(out[0].p_D.x(), 0.01F);
  }
}

TEST(PointGate, LetsPointsMeetIfTheDeviceHasNoBound) {
  PointGate gate;
  gate.configure(2, {.least_separation = 0.0, .fade = kFade});
  std::vector<FocusSample> out(2);
  for (int i = 0; i < 100; ++i) gate.step(std::vector{focus(0.01, 0.5), focus(0.01, 0.5)}, out);
  EXPECT_EQ(out[1].intensity, 0.5F);
  EXPECT_EQ(gate.weakened(), 0);
}

TEST(PointGate, FadesTheWeakerOutBeforeTheyMeetAndInAfterwards) {
  PointGate gate;
  gate.configure(2, kBounds);
  std::vector<FocusSample> out(2);
  // passes at 0.4 mm per sample: too close for |x| < 10 mm
  for (int i = 0; i < 300; ++i) {
    gate.step(std::vector{focus(0.0, 1.0), focus(4e-4 * (i - 150), 0.5)}, out);
    if (i < kFade) continue;
    ASSERT_EQ(out[0].intensity, 1.0F) << "the stronger is unchanged";
    const int sample = i - kFade - 150;  // samples from the middle
    const double gain = static_cast<double>(out[1].intensity) / 0.5;
    const int outside = std::abs(sample) - 24;  // samples to the nearest one that is too close
    ASSERT_NEAR(gain, std::min(1.0, std::max(0, outside) / double(kFade)), 1e-6) << sample;
  }
}

TEST(PointGate, DoesNotAlternateBetweenEqualPoints) {
  PointGate gate;
  gate.configure(2, kBounds);
  std::vector<FocusSample> out(2);
  int turns = 0;
  bool first_sounds = true;
  for (int i = 0; i < 2000; ++i) {
    const double ripple = 0.1 * std::sin(0.1 * i);
    gate.step(std::vector{focus(0.0, 0.5 + ripple), focus(0.001, 0.5 - ripple)}, out);
    if (i < 2 * kFade) continue;
    const bool sounds = out[0].intensity > out[1].intensity;
    if (i > 2 * kFade) turns += sounds != first_sounds ? 1 : 0;
    first_sounds = sounds;
  }
  EXPECT_EQ(turns, 0);
}

TEST(PointGate, SwitchesToAPointThatBecomesMuchStronger) {
  PointGate gate;
  gate.configure(2, kBounds);
  std::vector<FocusSample> out(2);
  for (int i = 0; i < 500; ++i) {
    const double t = std::clamp((i - 200) / 100.0, 0.0, 1.0);
    gate.step(std::vector{focus(0.0, 1.0 - t), focus(0.001, t)}, out);
    ASSERT_TRUE(out[0].intensity == 0.0F || out[1].intensity == 0.0F);
  }
  EXPECT_EQ(out[1].intensity, 1.0F);
}

/// Points in a small space that move and change at random, as fast as an emission may.
class RandomPoints {
 public:
  RandomPoints(unsigned seed, int foci, double rate)
      : random_(seed), step_(8.0 / rate), change_(1e3 / rate), points_(std::size_t(foci)) {}

  const std::vector<FocusSample>& next() {
    for (FocusSample& point : points_) {
      const auto step = static_cast<float>(step_ / std::sqrt(3.0));
      for (int axis = 0; axis < 3; ++axis) {
        float& x = point.p_D[axis];
        x = std::clamp(x + step * static_cast<float>(unit_(random_)), -0.015F, 0.015F);
      }
      const double change = change_ * unit_(random_);
      point.intensity = std::clamp(point.intensity + static_cast<float>(change), 0.0F, 1.0F);
      if (unit_(random_) > 0.998) point.intensity = std::nanf("");
    }
    given_ = points_;
    // continues from the valid value
    for (FocusSample& point : points_) {
      if (!std::isfinite(point.intensity)) point.intensity = 0.0F;
    }
    return given_;
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
  double step_, change_;
  std::vector<FocusSample> points_, given_;
};

TEST(PointGate, KeepsRandomPointsApartWithoutClicks) {
  for (const int foci : {2, 4, 8}) {
    RandomPoints source(static_cast<unsigned>(foci), foci, 16e3);
    PointGate gate;
    gate.configure(foci, kBounds);
    std::vector<FocusSample> out(static_cast<std::size_t>(foci)), last = out, in = out;
    double largest = 0.0, sum = 0.0;
    std::size_t allocations = 0;
    for (int i = 0; i < 100'000; ++i) {
      in = source.next();
      const test::HeapGuard guard;
      gate.step(in, out);
      allocations += guard.allocations();
      for (std::size_t a = 0; a < out.size(); ++a) {
        ASSERT_TRUE(std::isfinite(out[a].intensity));
        largest = std::max(largest, std::abs(static_cast<double>(out[a].intensity) -
                                             static_cast<double>(last[a].intensity)));
        sum += static_cast<double>(out[a].intensity);
        for (std::size_t b = 0; b < a; ++b) {
          if (out[a].intensity == 0.0F || out[b].intensity == 0.0F) continue;
          ASSERT_GE(static_cast<double>((out[a].p_D - out[b].p_D).norm()), kLeast * 0.9999) << i;
        }
      }
      last = out;
    }
    EXPECT_LE(largest, 2.0 / kFade + 1e-6) << "the source's change plus a step of the fade";
    EXPECT_GT(sum / 100'000, 0.1) << "the gate does not mute everything";
    EXPECT_EQ(allocations, 0U);
    EXPECT_GT(gate.weakened(), 1000);
  }
}

}  // namespace
}  // namespace prostm
