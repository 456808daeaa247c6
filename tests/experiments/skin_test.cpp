#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/file/file.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/plan/gain.hpp"

namespace prostm::experiments {
namespace {

TEST(SkinBench, LapsAreClosedAndAtConstantSpeed) {
  const struct {
    Lap lap;
    double length;
  } cases[] = {{circle_lap(0.1), 0.1}, {square_lap(0.03), 0.12}, {line_lap(0.05), 0.1}};
  for (const auto& [lap, length] : cases) {
    EXPECT_LT((lap(1.0) - lap(0.0)).norm(), 1e-12);
    constexpr int kSteps = 1000;
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) {
      const double step = (lap((k + 1.0) / kSteps) - lap(static_cast<double>(k) / kSteps)).norm();
      EXPECT_LT(step, length / kSteps * (1.0 + 1e-9));
      sum += step;
    }
    EXPECT_NEAR(sum, length, 1e-5);
  }
}

TEST(SkinBench, APeakIsInterpolatedBetweenTheValues) {
  std::vector<double> x, y;
  for (int i = 0; i < 9; ++i) {
    x.push_back(i);
    y.push_back(2.0 - (i - 4.3) * (i - 4.3));
  }
  EXPECT_NEAR(peak_place(x, y), 4.3, 1e-12);
  std::sort(y.begin(), y.end());
  EXPECT_EQ(peak_place(x, y), 8.0);
}

/// Largest radiation pressure in a sample, and its position.
struct Strongest {
  double pressure;
  Vec2 at;
};
Strongest strongest(const std::vector<double>& pressure, const Palm& palm, int sample) {
  const auto first = pressure.begin() + static_cast<std::ptrdiff_t>(palm.cells()) * sample;
  const auto most = std::max_element(first, first + static_cast<std::ptrdiff_t>(palm.cells()));
  const int cell = static_cast<int>(most - first);
  return {*most, palm.at(cell / palm.patch.cols, cell % palm.patch.cols)};
}

TEST(SkinBench, TheFieldFollowsTheLap) {
  const Palm palm;
  const TransducerArray array = usx_array();
  const StmField field(array, palm);
  const Lap lap = circle_lap(0.1);
  for (const double speed : {2.0, 10.0}) {
    const std::vector<double> ideal = field.pressure(lap, 0.1 / speed, true);
    const std::vector<double> real = field.pressure(lap, 0.1 / speed, false);
    for (const int sample : {0, 1, 40, 95}) {
      const Vec2 asked = lap(static_cast<double>(sample) / StmField::kSamples);
      const Strongest at_once = strongest(ideal, palm, sample);
      EXPECT_LT((at_once.at - asked).norm(), 2.2e-3);
      // all in phase at the focus: the sum of the amplitudes by (A1)
      double sum = 0.0;
      for (std::size_t n = 0; n < array.position.size(); ++n) {
        sum += std::abs(propagate(array, Medium(), n, Vec3(asked.x(), asked.y(), palm.height)));
      }
      const double expected = radiation_pressure(sum, Medium());
      EXPECT_LT(at_once.pressure, expected * 1.001);
      EXPECT_GT(at_once.pressure, expected * 0.9);  // the nearest cell is up to 1.4 mm away
      const Strongest lagging = strongest(real, palm, sample);
      EXPECT_LT((lagging.at - asked).norm(), 2.2e-3 + speed * 0.228e-3);
      EXPECT_LT(lagging.pressure, at_once.pressure * 1.03);
    }
    double total = 0.0, total_ideal = 0.0;
    for (int k = 0; k < StmField::kSamples; ++k) {
      total += strongest(real, palm, k).pressure;
      total_ideal += strongest(ideal, palm, k).pressure;
    }
    EXPECT_NEAR(total / total_ideal, speed < 5.0 ? 0.995 : 0.90, 0.015);
  }
}

TEST(SkinBench, TwoFociAreEqualAndWeakerThanOne) {
  const Palm palm;
  const std::vector<double> one = foci_pressure(usx_array(), palm, {Vec2(1e-3, 1e-3)});
  const std::vector<double> two =
      foci_pressure(usx_array(), palm, {Vec2(-21e-3, 1e-3), Vec2(21e-3, 1e-3)});
  const auto at = [&](const std::vector<double>& pressure, int col) {
    return pressure[static_cast<std::size_t>(24 * palm.patch.cols + col)];
  };
  EXPECT_NEAR(at(two, 13) / at(two, 34), 1.0, 1e-3);  // −21 and +21 mm
  EXPECT_LT(at(two, 13), 0.55 * at(one, 24));
  EXPECT_GT(at(two, 13), 0.3 * at(one, 24));
}

TEST(SkinBench, ThePlannersGainsMatchTheModel) {
  const std::array<SkinSettings, 1> nominal = {SkinSettings()};
  const std::array<double, 1> usual = {kUsualSpeed};
  const LoopTable table = loop_table(kLoopLengths, usual, nominal, [] {});
  ASSERT_EQ(kSkinGains.size(), kLoopLengths.size());
  const double longest = table.nominal().back()[0].along;
  for (std::size_t l = 0; l < kLoopLengths.size(); ++l) {
    EXPECT_NEAR(longest / table.nominal()[l][0].along, kSkinGains[l], 6e-4) << l;
    EXPECT_NEAR(skin_gain(kLoopLengths[l] / usual[0]), kSkinGains[l], 1e-9);
  }
}

TEST(SkinBench, SmallLoopsAreStrongestAtTheFastestSpeed) {
  const std::array<SkinSettings, 1> nominal = {SkinSettings()};
  const std::array<double, 1> length = {0.070};
  const LoopTable table = loop_table(length, kLoopSpeeds, nominal, [] {});
  const auto& by_speed = table.nominal()[0];
  EXPECT_EQ(strongest_speed(table, 0, 0, &LoopStrength::along), 8.0);
  EXPECT_EQ(strongest_speed(table, 0, 0, &LoopStrength::intensity), 8.0);
  EXPECT_GT(by_speed[5].along, 5.0 * by_speed[0].along);
}

TEST(SkinBench, AChartOfOneCircleHasItsOwnLabel) {
  const CircleCurves of{
      0.123, {1.0, 2.0, 3.0}, {{{1e-6, 2e-6, 1e-6}, {}, {}}}, {{1e-6, 1e-6, 1e-6}, {}, {}}};
  const std::string file = testing::TempDir() + "one_circle.png";
  draw_circles({of}, file);

  CircleCurves other = of;
  other.circumference = 0.05;
  const std::string other_file = testing::TempDir() + "another_circle.png";
  draw_circles({other}, other_file);
  EXPECT_NE(read_file(file), read_file(other_file));
}

TEST(SkinBench, TablesKnowTheirOwnLengthsAndSpeeds) {
  const std::array<SkinSettings, 1> nominal = {SkinSettings()};
  const std::array<double, 1> length = {0.1};
  const std::array<double, 2> speeds = {kUsualSpeed, 5.0};
  const LoopTable table = loop_table(length, speeds, nominal, [] {});
  EXPECT_EQ(table.lengths, std::vector<double>{0.1});
  EXPECT_EQ(table.usual_speed(), 0u);
  EXPECT_EQ(strongest_speed(table, 0, 0, &LoopStrength::along), kUsualSpeed);
}

}  // namespace
}  // namespace prostm::experiments
