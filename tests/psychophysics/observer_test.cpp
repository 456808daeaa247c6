/// Observers: closed forms, limits, and invariants on random percepts.
#include "prostm/psychophysics/observer.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/psychophysics/places.hpp"

namespace prostm {
namespace {

const SkinPatch kPatch{48, 48, 2e-3};

/// A percept with Gaussian lumps of σ 6 mm at places.
FeltStimulus lumps(const std::vector<Vec2>& places, double strength = 1.0) {
  FeltStimulus out;
  out.map.resize(kPatch.size());
  for (int j = 0; j < kPatch.rows; ++j) {
    for (int i = 0; i < kPatch.cols; ++i) {
      const Vec2 x = kPatch.cell * Vec2(i - 23.5, j - 23.5);
      for (const Vec2& place : places)
        out.map[static_cast<std::size_t>(j * kPatch.cols + i)] +=
            strength * std::exp(-(x - place).squaredNorm() / (2.0 * 6e-3 * 6e-3));
    }
  }
  out.map = blurred(kPatch, out.map, kTouchResolution);
  out.strength = places.empty() ? 0.0 : strength;
  for (const Vec2& place : places) out.course.push_back({0.25, place});
  return out;
}

Observer observer(Readout readout, double noise = 1.0, double threshold = 1e-6) {
  return {PerceptModel::Peak,
          readout,
          {.threshold = threshold,
           .noise = noise,
           .criterion = readout == Readout::Category ? 0.4 : 0.0}};
}

TEST(Observer, DetectsHalfAtThreshold) {
  const Observer of = observer(Readout::Template, 1.0, 2.0);
  EXPECT_NEAR(of.detects(lumps({Vec2::Zero()}, 2.0)), 0.5, 1e-12);
  // one standard deviation of people is 4 dB
  EXPECT_NEAR(of.detects(lumps({Vec2::Zero()}, 2.0 * std::pow(10.0, 4.0 / 20.0))), 0.841345, 1e-6);
  EXPECT_LT(of.detects(lumps({})), 1e-12);
}

TEST(Observer, PrefersByTheRatio) {
  const Observer of = observer(Readout::Template);
  EXPECT_NEAR(of.prefers(lumps({Vec2::Zero()}), lumps({Vec2::Zero()})), 0.5, 1e-12);
  // 2 dB are one standard deviation
  EXPECT_NEAR(of.prefers(lumps({Vec2::Zero()}, std::pow(10.0, 0.1)), lumps({Vec2::Zero()})),
              0.841345, 1e-6);
  Random random(5);
  FeltStimulus a, b;
  for (int i = 0; i < 100'000; ++i) {
    a.strength = random.uniform(0.0, 3.0);
    b.strength = random.uniform(0.0, 3.0);
    ASSERT_NEAR(of.prefers(a, b) + of.prefers(b, a), 1.0, 1e-12);
  }
}

TEST(Observer, ADipHasAClosedForm) {
  // two lumps of σ_all² = 6² + 8.5² at ±20 mm: the middle is 2 e^{−20²/2σ²}, the ends 1 +
  // e^{−40²/2σ²}
  const Vec2 a(-20e-3, 0.0), b(20e-3, 0.0);
  const double variance = 36.0 + 72.25;
  const double middle = 2.0 * std::exp(-400.0 / (2.0 * variance));
  const double ends = 1.0 + std::exp(-1600.0 / (2.0 * variance));
  EXPECT_NEAR(dip_between(lumps({a, b}), a, b), 1.0 - middle / ends, 0.01);
  EXPECT_EQ(dip_between(lumps({Vec2::Zero()}), Vec2(-5e-3, 0.0), Vec2(5e-3, 0.0)), 0.0);
  EXPECT_EQ(dip_between(lumps({}), a, b), 0.0);
}

TEST(Observer, TwoIsAnsweredMoreOftenAtWiderGaps) {
  const auto pair = [](double gap) { return lumps({Vec2(-gap / 2, 0.0), Vec2(gap / 2, 0.0)}); };
  for (const Readout readout : {Readout::Template, Readout::Category}) {
    const Observer of = observer(readout, readout == Readout::Category ? 0.2 : 1.0);
    double before = 0.0;  // dips begin above 20 mm
    for (double gap = 15e-3; gap < 50e-3; gap += 5e-3) {
      const double two = of.says_two(pair(gap), {Vec2(-gap / 2, 0.0), Vec2(gap / 2, 0.0)},
                                     pair(15e-3), pair(45e-3));
      EXPECT_GE(two, before);
      before = two;
    }
  }
  // unbiased between the two that are certain
  const Observer of = observer(Readout::Template);
  const std::array ends = {Vec2(0.0, 0.0), Vec2(0.0, 0.0)};
  EXPECT_NEAR(of.says_two(pair(15e-3), ends, pair(15e-3), pair(45e-3)) +
                  of.says_two(pair(45e-3), ends, pair(15e-3), pair(45e-3)),
              1.0, 1e-9);
}

TEST(Observer, ThePlaceOfALumpHasTheCramerRaoBound) {
  // dense places approach information π/(2 s²) / κ² of a Gaussian with spacing s, whatever its
  // width
  const double expected = kTouchResolution * std::sqrt(2.0 / kPi);
  EXPECT_NEAR(observer(Readout::Template).place_noise(lumps({Vec2::Zero()})), expected,
              0.05 * expected);
  EXPECT_NEAR(observer(Readout::Template, 2.0).place_noise(lumps({Vec2::Zero()})), 2.0 * expected,
              0.1 * expected);
  EXPECT_EQ(observer(Readout::Category).place_noise(lumps({Vec2::Zero()})),
            ObserverParameters{}.place);
}

TEST(Observer, ConfusionsAreTheNormalIntegral) {
  // two alternatives of the same power, so that the common noise does not matter: d′/2 decides
  const FeltStimulus a = lumps({Vec2(-5e-3, 0.0)}), b = lumps({Vec2(5e-3, 0.0)});
  const double noise = 0.8;
  const Observer of = observer(Readout::Template, noise);
  const auto matrix = of.confusions(std::array{&a, &b});
  const auto x = a.places(), y = b.places();
  double square = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    square += (x[i] - y[i]) * (x[i] - y[i]);
    largest = std::max(largest, x[i]);
  }
  const double right =
      0.5 * std::erfc(-std::sqrt(square) / (2.0 * noise * largest) / std::sqrt(2.0));
  EXPECT_NEAR(matrix[0][0], right, 0.04);
  EXPECT_NEAR(matrix[1][1], right, 0.04);
  for (const auto& row : matrix) EXPECT_NEAR(row[0] + row[1], 1.0, 1e-9);
}

TEST(Observer, ConfusionsGuessWithoutASignal) {
  const FeltStimulus a = lumps({Vec2::Zero()}), b = lumps({Vec2::Zero()});
  const auto matrix = observer(Readout::Template, 1e3).confusions(std::array{&a, &b});
  EXPECT_NEAR(matrix[0][0] + matrix[0][1], 1.0, 1e-9);
  const FeltStimulus none = lumps({});
  const auto nothing = observer(Readout::Template).confusions(std::array{&none, &none});
  EXPECT_NEAR(nothing[0][0], 1.0, 1e-9);
}

TEST(Observer, CountsFewerPointsMoreOften) {
  const std::vector<Vec2> four = {Vec2(-20e-3, -20e-3), Vec2(20e-3, -20e-3), Vec2(-20e-3, 20e-3),
                                  Vec2(20e-3, 20e-3)};
  const Observer of = observer(Readout::Category, 0.2);
  const double two = of.counts(lumps({four[0], four[1]}), {four[0], four[1]});
  EXPECT_GT(two, of.counts(lumps(four), four));
  EXPECT_GT(of.counts(lumps({four[0]}), {four[0]}), two);
  EXPECT_EQ(of.counts(lumps({}), {}), 1.0);
}

TEST(Observer, DirectionFollowsTheDelay) {
  FeltStimulus felt = lumps({Vec2::Zero()});
  const Observer of = observer(Readout::Template);
  EXPECT_EQ(of.tells_direction(felt), 0.5);
  felt.delay = std::sqrt(2.0) * kPerceptTime / std::sqrt(12.0);
  EXPECT_NEAR(of.tells_direction(felt), 0.841345, 1e-6);
}

TEST(Observer, CurvatureIgnoresTheCommonPlace) {
  const auto arc = [](double radius, const Vec2& shift) {
    FeltStimulus out = lumps({Vec2::Zero()});
    out.course.clear();
    for (int i = 0; i < 16; ++i) {
      const double s = 0.08 * ((i + 0.5) / 16 - 0.5) / radius;
      out.course.push_back({0.125, shift + radius * Vec2(std::sin(s), 1.0 - std::cos(s))});
    }
    return out;
  };
  const FeltStimulus point = lumps({Vec2::Zero()});
  const Observer of = observer(Readout::Category);
  const std::array curvatures = {25.0, 27.5};
  const double weber =
      of.curvature_weber(point, arc(0.04, Vec2::Zero()), arc(1.0 / 27.5, Vec2::Zero()), curvatures);
  EXPECT_NEAR(of.curvature_weber(point, arc(0.04, Vec2::Zero()), arc(1.0 / 27.5, Vec2(0.01, 0.02)),
                                 curvatures),
              weber, 1e-9);
  EXPECT_GT(weber, 0.1);
  EXPECT_LT(weber, 5.0);
}

}  // namespace
}  // namespace prostm
