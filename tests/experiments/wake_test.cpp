#include "prostm/experiments/wake.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "acoustics/skin_loops.hpp"

namespace prostm {
namespace {

/// Returns a skin of nearly constant wave speed, 5 m/s, at the frequencies of a moving 4 mm focus.
SkinModel nearly_plain() {
  SkinSettings settings;
  settings.slow_speed = 4.56;
  settings.fast_speed = 5.0;
  settings.loss = 0.00314;
  return SkinModel(settings);
}

const SkinPatch kPatch{121, 121, 2e-3};
constexpr int kAhead = 20;  // columns ahead of the focus

/// Computes the wake of a focus of 1 N with σ = 4 mm, kAhead columns from the patch's right edge.
std::vector<double> wake(const SkinModel& skin, double speed) {
  std::vector<double> pressure;
  const double sigma = 4e-3;
  const Vec2 middle = test::cell_centre(kPatch, kPatch.rows / 2, kPatch.cols - 1 - kAhead);
  for (int j = 0; j < kPatch.rows; ++j) {
    for (int i = 0; i < kPatch.cols; ++i) {
      const double square = (test::cell_centre(kPatch, j, i) - middle).squaredNorm();
      pressure.push_back(std::exp(-0.5 * square / (sigma * sigma)) / (2.0 * kPi * sigma * sigma));
    }
  }
  return wake_velocity(skin, kPatch, pressure, speed);
}

/// Height and velocity of the fastest skin in a column, in the upper half.
struct Crest {
  double height, value;  ///< [m] above the line of motion, [m/s]
};
Crest crest(const std::vector<double>& velocity, int col) {
  Crest found{0.0, 0.0};
  for (int j = kPatch.rows / 2; j < kPatch.rows; ++j) {
    const double value = std::abs(velocity[static_cast<std::size_t>(j * kPatch.cols + col)]);
    if (value > found.value) found = {kPatch.cell * (j - kPatch.rows / 2), value};
  }
  return found;
}

/// Returns the angle between the wake's crest and the line of motion [°], from a straight line
/// through the crests 30 to 110 mm behind the focus.
double wake_angle(const std::vector<double>& velocity) {
  double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (int behind = 15; behind <= 55; ++behind) {
    const double distance = behind * kPatch.cell;
    const double height = crest(velocity, kPatch.cols - 1 - kAhead - behind).height;
    n += 1.0;
    x += distance;
    y += height;
    xx += distance * distance;
    xy += distance * height;
  }
  return std::atan2(n * xy - x * y, n * xx - x * x) * 180.0 / kPi;
}

TEST(SkinWake, HasTheMachAngle) {
  const SkinModel skin = nearly_plain();
  for (const double speed : {7.5, 9.0, 12.0, 15.0}) {
    const double expected = std::asin(5.0 / speed) * 180.0 / kPi;
    EXPECT_NEAR(wake_angle(wake(skin, speed)), expected, 3.0) << speed;
  }
}

// The wake of the real skin moves at the wave speed of the frequencies that the focus excites.
TEST(SkinWake, HasTheMachAngleAtThePlateau) {
  const SkinModel skin{SkinSettings{}};
  for (const double speed : {10.0, 12.0, 15.0}) {
    const double expected = std::asin(7.0 / speed) * 180.0 / kPi;
    EXPECT_NEAR(wake_angle(wake(skin, speed)), expected, 3.0) << speed;
  }
}

TEST(SkinWake, HasNoFrontBelowTheWaveSpeed) {
  const SkinModel skin = nearly_plain();
  const auto far_share = [&](double speed) {
    const std::vector<double> velocity = wake(skin, speed);
    double most = 0.0;
    for (const double value : velocity) most = std::max(most, std::abs(value));
    return crest(velocity, kPatch.cols - 1 - kAhead - 40).value / most;  // 80 mm behind
  };
  EXPECT_LT(far_share(2.5), 0.01);
  EXPECT_LT(far_share(4.0), 0.03);
  EXPECT_GT(far_share(7.5), 0.08);
  EXPECT_GT(far_share(12.0), 0.08);
}

TEST(SkinWake, IsSymmetric) {
  const SkinModel skin{SkinSettings{}};
  const std::vector<double> velocity = wake(skin, 8.0);
  double most = 0.0, difference = 0.0;
  for (int j = 0; j < kPatch.rows; ++j) {
    for (int i = 0; i < kPatch.cols; ++i) {
      const double here = velocity[static_cast<std::size_t>(j * kPatch.cols + i)];
      const auto other = static_cast<std::size_t>((kPatch.rows - 1 - j) * kPatch.cols + i);
      most = std::max(most, std::abs(here));
      difference = std::max(difference, std::abs(here - velocity[other]));
    }
  }
  EXPECT_LT(difference, 1e-9 * most);
}

TEST(SkinWake, InputIsChecked) {
  const SkinModel skin{SkinSettings{}};
  const std::vector<double> pressure(4, 1.0);
  EXPECT_THROW(wake_velocity(skin, {2, 2, 2e-3}, pressure, 0.0), std::invalid_argument);
  EXPECT_THROW(wake_velocity(skin, {2, 3, 2e-3}, pressure, 1.0), std::invalid_argument);
  EXPECT_THROW(wake_velocity(skin, {2, 2, 2.0}, pressure, 1.0), std::invalid_argument);
  SkinSettings lossless{5.0, 5.0, 0.0};
  EXPECT_THROW(wake_velocity(SkinModel(lossless), {2, 2, 2e-3}, pressure, 1.0),
               std::invalid_argument);
}

}  // namespace
}  // namespace prostm
