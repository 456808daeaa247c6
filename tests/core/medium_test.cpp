#include "prostm/core/medium.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

Medium air_at(double celsius, double humidity) {
  Medium air;
  air.temperature = 273.15 + celsius;
  air.humidity = humidity;
  return air;
}

/// Returns what remains of (M5) if both relaxations are far too slow to follow.
double classical(const Medium& air, double frequency) {
  return 1.84e-11 * frequency * frequency * std::sqrt(air.temperature / 293.15) * 101325.0 /
         air.pressure;
}

// ISO 9613-2:1996, Table 2: dB/km at the octave bands from 63 Hz to 8 kHz, whose exact centres are
// 1000·10^{0.3n} Hz. The table gives two or three digits.
TEST(Absorption, AgreesWithTheStandardsTable) {
  struct Row {
    double celsius, humidity;
    std::array<double, 8> db_per_km;
  };
  const Row table[] = {
      {10.0, 0.7, {0.1, 0.4, 1.0, 1.9, 3.7, 9.7, 32.8, 117.0}},
      {20.0, 0.7, {0.1, 0.3, 1.1, 2.8, 5.0, 9.0, 22.9, 76.6}},
      {30.0, 0.7, {0.1, 0.3, 1.0, 3.1, 7.4, 12.7, 23.1, 59.3}},
      {15.0, 0.2, {0.3, 0.6, 1.2, 2.7, 8.2, 28.2, 88.8, 202.0}},
      {15.0, 0.5, {0.1, 0.5, 1.2, 2.2, 4.2, 10.8, 36.2, 129.0}},
      {15.0, 0.8, {0.1, 0.3, 1.1, 2.4, 4.1, 8.3, 23.7, 82.8}},
  };
  for (const Row& row : table) {
    for (int band = 0; band < 8; ++band) {
      const double frequency = 1000.0 * std::pow(10.0, 0.3 * (band - 4));
      const double listed = row.db_per_km[static_cast<std::size_t>(band)];
      EXPECT_NEAR(1000.0 * air_at(row.celsius, row.humidity).absorption_db(frequency), listed,
                  listed > 100.0 ? 0.5 : 0.06)
          << row.celsius << " °C, " << row.humidity << ", " << frequency << " Hz";
    }
  }
}

TEST(Absorption, IsAboutADecibelAMetreAtTheCarrier) {
  const Medium air;
  EXPECT_NEAR(air.absorption_db(4e3), 29.7e-3, 0.05e-3);
  EXPECT_NEAR(air.absorption_db(10e3), 159e-3, 0.5e-3);
  EXPECT_NEAR(air.absorption_db(40e3), 1.318, 0.001);
  EXPECT_NEAR(air.absorption(40e3), 0.1518, 0.0001);
}

TEST(Absorption, DecibelsAndNepersAgree) {
  const Medium air;
  const double r = 3.7;
  EXPECT_NEAR(-20.0 * std::log10(std::exp(-air.absorption(40e3) * r)), air.absorption_db(40e3) * r,
              1e-12);
}

// At a fixed fraction of water, absorption per wavelength depends on frequency over pressure.
TEST(Absorption, FollowsFrequencyOverPressure) {
  Random random(11);
  for (int trial = 0; trial < 200; ++trial) {
    Medium air = air_at(random.uniform(-10.0, 40.0), random.uniform(0.0, 0.4));
    const double frequency = random.uniform(50.0, 100e3), factor = random.uniform(0.5, 2.0);
    const double expected = air.absorption(frequency) * factor;
    air.pressure *= factor;
    air.humidity *= factor;
    EXPECT_NEAR(air.absorption(frequency * factor), expected, 1e-9 * expected);
  }
}

// All terms are positive, so the sum exceeds the classical term and rises with frequency.
TEST(Absorption, RisesWithFrequencyAboveTheClassicalPart) {
  Random random(12);
  for (int trial = 0; trial < 200; ++trial) {
    const Medium air = air_at(random.uniform(-10.0, 40.0), random.uniform(0.0, 1.0));
    const double frequency = random.uniform(50.0, 100e3);
    EXPECT_GT(air.absorption(1.01 * frequency), air.absorption(frequency));
    EXPECT_GT(air.absorption(frequency), classical(air, frequency));
  }
  // far above the relaxation frequencies of dry air (24 and 9 Hz) they add a constant
  const Medium dry = air_at(20.0, 0.0);
  const double oxygen = 0.01275 * std::exp(-2239.1 / 293.15) * 24.0;
  const double nitrogen = 0.1068 * std::exp(-3352.0 / 293.15) * 9.0;
  EXPECT_NEAR(dry.absorption(1e6) - classical(dry, 1e6), oxygen + nitrogen, 1e-8);
}

}  // namespace
}  // namespace prostm
