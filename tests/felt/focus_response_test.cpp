#include "prostm/felt/focus_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 4.3e-3, kPeriod = 20e-3;

/// Returns the percept's harmonic n at every cell of a raster with a Gaussian focus in its middle
/// that pulses once per period, computed by the harmonic sum of the skin.
std::vector<std::complex<double>> pulsing_focus(int cells, double cell, int n) {
  constexpr int kSamples = 64;
  SkinResponse response(SkinModel(SkinSettings()), {cells, cells, cell});
  response.prepare(kPeriod, kSamples);
  const auto count = static_cast<std::size_t>(cells * cells);
  std::vector<double> pressure(count * kSamples);
  for (int k = 0; k < kSamples; ++k) {
    const double course = std::cos(2.0 * kPi * n * k / kSamples);
    for (int j = 0; j < cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        const double r = cell * std::hypot(j - cells / 2, i - cells / 2) / kSigma;
        pressure[static_cast<std::size_t>((k * cells + j) * cells + i)] =
            course * std::exp(-0.5 * r * r);
      }
    }
  }
  response.respond({kPeriod, kSamples, pressure});
  const auto field = response.displacement(n);
  return {field.begin(), field.end()};
}

TEST(FocusResponse, MatchesTheSkinAroundAFocus) {
  constexpr int kCells = 65;
  constexpr double kCell = 2e-3;
  FocusResponseMaker maker;
  FocusResponse<double> table;
  maker.make(SkinModel(SkinSettings()), kSigma, kPeriod, table);
  const int first = first_felt_harmonic(kPeriod);
  for (const int part : {0, 3, 7}) {
    const int n = first + part;
    const double felt = 1e6 * pacinian_sensitivity(n / kPeriod) / std::sqrt(2.0);
    const auto field = pulsing_focus(kCells, kCell, n);
    double largest = 0.0, worst = 0.0;
    for (int i = 0; i < kCells; ++i) {
      const auto row = table.at(1e3 * kCell * std::abs(i - kCells / 2));
      const auto real = static_cast<std::size_t>(part), imaginary = real + kFeltParts / 2;
      const std::complex<double> tabled(row.value[real], row.value[imaginary]);
      const auto at = static_cast<std::size_t>(kCells / 2 * kCells + i);
      largest = std::max(largest, std::abs(felt * field[at]));
      worst = std::max(worst, std::abs(felt * field[at] - tabled));
    }
    EXPECT_LT(worst, 2e-3 * largest) << "harmonic " << n;
  }
}

TEST(FocusResponse, HasTheDerivativesOfItsValues) {
  FocusResponseMaker maker;
  FocusResponse<double> table;
  maker.make(SkinModel(SkinSettings()), kSigma, kPeriod, table);
  Random random(1);
  for (int draw = 0; draw < 1000; ++draw) {
    const double r = random.uniform(0.01, 290.0), h = 1e-4;
    const auto here = table.at(r), before = table.at(r - h), after = table.at(r + h);
    for (std::size_t i = 0; i < kFeltParts; ++i) {
      const double difference = (after.value[i] - before.value[i]) / (2.0 * h);
      ASSERT_NEAR(here.slope[i], difference, 1e-7 * table.largest) << r;
    }
  }
}

TEST(FocusResponse, FarAwayEqualsTheLastTabulatedDistance) {
  FocusResponseMaker maker;
  FocusResponse<float> table;
  maker.make(SkinModel(SkinSettings()), kSigma, kPeriod, table);
  constexpr double kLast = FocusResponse<float>::kStep * (FocusResponse<float>::kDistances - 1);
  EXPECT_EQ(table.at(1e4F).value, table.at(static_cast<float>(kLast)).value);
  EXPECT_EQ(table.at(0.0F).value, table.cubic.front().by_power[0]);
}

TEST(FirstFeltHarmonic, IsTheFirstFrom90Hz) {
  EXPECT_EQ(first_felt_harmonic(20e-3), 2);
  EXPECT_EQ(first_felt_harmonic(5e-3), 1);
  EXPECT_EQ(first_felt_harmonic(10e-3), 1);
  EXPECT_EQ(first_felt_harmonic(40e-3), 4);
}

}  // namespace
}  // namespace prostm
