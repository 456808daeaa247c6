/// From stimuli to percepts: calibration, the skin's vibration, models and controls.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/psychophysics/felt_stimulus.hpp"
#include "prostm/psychophysics/places.hpp"

namespace prostm {
namespace {

const SkinPatch kPatch{48, 48, 2e-3};

Vibration vibration_of(const PresentedStimulus& stimulus) {
  Vibration out;
  Presenter(SkinModel(SkinSettings{}).settings(), at_measured_amplitude(usx_array()))
      .present(stimulus, 0.2, [&](const Vibration& vibration, double) { out = vibration; });
  return out;
}

TEST(Presenter, TheFocusHasTheMeasuredLevel) {
  const Vibration point = vibration_of(AmPoints{{Vec2::Zero()}, {200.0}});
  // 155 dB are 1125 Pa rms; radiation pressure on a reflecting surface is 2 p²/(ρc²), (A5)
  const double expected = radiation_pressure(20e-6 * std::pow(10.0, 155.0 / 20.0), Medium{});
  EXPECT_NEAR(expected, 17.8, 0.1);
  // the nearest cells are 1.4 mm from the focus, whose σ is 4.3 mm
  EXPECT_NEAR(std::ranges::max(point.largest), expected * std::exp(-2.0 / (2.0 * 4.3 * 4.3)),
              0.02 * expected);
}

TEST(Presenter, TheMeanOfAModulatedPointIsThreeEighths) {
  const Vibration point = vibration_of(AmPoints{{Vec2::Zero()}, {200.0}});
  for (std::size_t c = 0; c < point.mean.size(); ++c)
    EXPECT_NEAR(point.mean[c], 0.375 * point.largest[c], 1e-9 + 1e-12 * point.largest[c]);
}

TEST(Presenter, ADiskHasItsForce) {
  const Vibration disk = vibration_of(Disk{1.8e-4, 4e-4, 200.0, 0.0});
  double largest = 0.0, mean = 0.0;
  for (std::size_t c = 0; c < disk.mean.size(); ++c) {
    largest += disk.largest[c] * kPatch.cell * kPatch.cell;
    mean += disk.mean[c] * kPatch.cell * kPatch.cell;
  }
  EXPECT_NEAR(largest, 4e-4, 1e-12);
  EXPECT_NEAR(mean, 2e-4, 1e-12);  // half of the time
  // the fundamental of a square wave is 4/π of half its height
  double fundamental = 0.0;
  for (std::size_t c = 0; c < disk.mean.size(); ++c)
    fundamental += std::abs(disk.pressure[c]) * kPatch.cell * kPatch.cell;
  EXPECT_NEAR(fundamental, 4.0 / kPi * 2e-4, 1e-3 * 2e-4);
}

TEST(Presenter, TheLowestForceFeltIsAtTheThresholdOfTouch) {
  const Vibration disk = vibration_of(Disk{1.8e-4, 4e-4, 200.0, 0.0});
  const double peak =
      strength_of(PerceptModel::Peak, disk.patch, percept_energy(PerceptModel::Peak, disk));
  EXPECT_NEAR(peak / kTouchThreshold, 1.0, 0.01);
}

TEST(Presenter, HarmonicsRestoreThePressure) {
  // Parseval: the mean square over time is that of the mean and of the harmonics
  const Vibration point = vibration_of(AmPoints{{Vec2(0.01, 0.0)}, {100.0}});
  const std::size_t cells = point.patch.size();
  for (std::size_t c = 0; c < cells; c += 37) {
    double square = point.mean[c] * point.mean[c];
    for (int n = 0; n < point.harmonics; ++n)
      square += 0.5 * std::norm(point.pressure[static_cast<std::size_t>(n) * cells + c]);
    // the mean of ((1 + cos)/2)⁴⁺⁴ over a period is 35/128
    EXPECT_NEAR(square, 35.0 / 128.0 * std::pow(point.largest[c], 2),
                1e-9 * std::pow(point.largest[c], 2) + 1e-12);
  }
}

TEST(PerceptModels, StrengthIsProportionalToPressure) {
  const Vibration weak = vibration_of(Disk{1.8e-4, 1e-4, 200.0, 0.0});
  const Vibration strong = vibration_of(Disk{1.8e-4, 3e-4, 200.0, 0.0});
  for (std::size_t m = 0; m < kPerceptModels; ++m) {
    const auto model = static_cast<PerceptModel>(m);
    const double a = strength_of(model, kPatch, percept_energy(model, weak));
    const double b = strength_of(model, kPatch, percept_energy(model, strong));
    EXPECT_GT(a, 0.0) << name_of(model);
    EXPECT_NEAR(b / a, 3.0, 1e-9) << name_of(model);
  }
}

TEST(PerceptModels, PeakAndAreaAreThoseOfTheSkin) {
  SkinResponse response(SkinModel(SkinSettings{}), kPatch);
  response.prepare(0.02, 64);
  Random random(3);
  std::vector<double> pressure(64 * kPatch.size());
  for (double& p : pressure) p = random.uniform();
  response.respond({0.02, 64, pressure});
  Vibration vibration{kPatch, 0.02, response.harmonics(), {}, {}, {}, {}};
  for (int n = 1; n <= response.harmonics(); ++n) {
    const auto w = response.displacement(n);
    vibration.displacement.insert(vibration.displacement.end(), w.begin(), w.end());
  }
  std::vector<double> map(kPatch.size());
  percept_map(response, map);
  const auto energy = percept_energy(PerceptModel::Peak, vibration);
  EXPECT_NEAR(strength_of(PerceptModel::Peak, kPatch, energy) / std::ranges::max(map), 1.0, 1e-12);
  EXPECT_NEAR(strength_of(PerceptModel::Area, kPatch, energy) / perceived_intensity(response), 1.0,
              1e-12);
}

TEST(PerceptModels, PopulationLiesBetweenPeakAndArea) {
  // a uniform percept on an area of 4 A_0: all cells equal, so the sums have closed forms
  const SkinPatch patch{34, 34, 1e-3};
  PerceptEnergy energy{std::vector<double>(patch.size(), 4e-14), std::vector<double>(patch.size())};
  const double areas = static_cast<double>(patch.size()) * 1e-6 / kPerceptArea;
  EXPECT_NEAR(strength_of(PerceptModel::Peak, patch, energy), 2e-7, 1e-18);
  EXPECT_NEAR(strength_of(PerceptModel::Area, patch, energy), 2e-7 * std::sqrt(areas), 1e-18);
  EXPECT_NEAR(strength_of(PerceptModel::Population, patch, energy), 2e-7 * std::pow(areas, 0.25),
              1e-18);
}

TEST(PerceptModels, ShuffledKeepsTheStrength) {
  const Vibration point = vibration_of(AmPoints{{Vec2::Zero()}, {200.0}});
  const auto peak = percept_energy(PerceptModel::Peak, point);
  const auto shuffled = percept_energy(PerceptModel::Shuffled, point);
  EXPECT_EQ(strength_of(PerceptModel::Peak, kPatch, peak),
            strength_of(PerceptModel::Shuffled, kPatch, shuffled));
  EXPECT_NE(peak.fast, shuffled.fast);
}

TEST(Places, ABlurKeepsTheSumAndAddsVariances) {
  std::vector<double> map(kPatch.size());
  map[24 * 48 + 24] = 1.0;
  const auto once = blurred(kPatch, map, 6e-3);
  const auto twice = blurred(kPatch, once, 6e-3),
             both = blurred(kPatch, map, 6e-3 * std::sqrt(2.0));
  double sum = 0.0;
  for (std::size_t c = 0; c < map.size(); ++c) {
    sum += once[c];
    EXPECT_NEAR(twice[c], both[c], 1e-6);
  }
  EXPECT_NEAR(sum, 1.0, 1e-3);
  const Vec2 place = centroid(kPatch, once);
  EXPECT_NEAR(place.x(), 1e-3, 1e-9);
  EXPECT_NEAR(place.y(), 1e-3, 1e-9);
}

TEST(Places, AShiftMovesTheMap) {
  std::vector<double> map(kPatch.size());
  Random random(1);
  for (double& v : map) v = random.uniform();
  map = blurred(kPatch, map, 4e-3);
  EXPECT_NEAR(
      value_at(kPatch, map, Vec2(5e-3, 7e-3)),
      at_grid(kPatch, map, 1e-3, Vec2(-5e-3, -7e-3))[static_cast<std::size_t>(47 * 95 + 47)],
      1e-12);
  EXPECT_EQ(value_at(kPatch, map, Vec2(0.2, 0.0)), 0.0);
}

TEST(Feeler, AWindowSeesTheWholeOfAFastCourse) {
  Feeler feeler(SkinSettings{}, at_measured_amplitude(usx_array()), [] {});
  const auto course = [](double lap) {
    return SlowPath{
        .way = corners(Outline::Circle, 0.04), .lap = lap, .moments = 8, .frequency = 200.0};
  };
  const FeltByModel& slow = feeler.feel("slow", course(16.0), 0.2);
  const FeltByModel& fast = feeler.feel("fast", course(0.25), 0.2);
  const FeltByModel& point =
      feeler.feel("point", AmPoints{{corners(Outline::Circle, 0.04)[0]}, {200.0}}, 0.2);
  const auto peak = static_cast<std::size_t>(PerceptModel::Peak);
  EXPECT_NEAR(slow[peak].strength / point[peak].strength, 1.0, 0.05);
  EXPECT_LT(fast[peak].strength, 0.75 * slow[peak].strength);
  EXPECT_EQ(slow[peak].course.size(), 8U);
  // the felt course goes around once
  for (const FeltPlace& at : slow[peak].course) EXPECT_NEAR(at.place.norm(), 0.02, 5e-3);
}

TEST(Feeler, ASweepArrivesLaterAtItsEnd) {
  Feeler feeler(SkinSettings{}, at_measured_amplitude(usx_array()), [] {});
  const FeltByModel& felt = feeler.feel("sweep", Sweep{0.1, 1.0, 0.02, 62.5}, 0.15);
  EXPECT_NEAR(felt[static_cast<std::size_t>(PerceptModel::Pressure)].delay, 0.1, 0.02);
  EXPECT_NEAR(felt[static_cast<std::size_t>(PerceptModel::Peak)].delay, 0.1, 0.05);
  EXPECT_EQ(felt[static_cast<std::size_t>(PerceptModel::MeanField)].delay, 0.0);
}

}  // namespace
}  // namespace prostm
