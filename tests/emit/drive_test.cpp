#include "prostm/emit/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/emit/detail/path_emitter.hpp"

namespace prostm {
namespace {

TEST(DriveIntensity, ItsSquareIsThePressure) {
  bool saturated = true;
  for (double pressure = 0.05; pressure <= 5.0; pressure += 0.01) {
    const double intensity = drive_intensity(pressure, 5.0, 0.01, saturated);
    EXPECT_FALSE(saturated);
    EXPECT_NEAR(intensity * intensity * 5.0, pressure, 1e-12);
  }
}

TEST(DriveIntensity, ClipsCountsAndFallsToZero) {
  bool saturated = false;
  EXPECT_EQ(drive_intensity(5.1, 5.0, 0.01, saturated), 1.0);
  EXPECT_TRUE(saturated);
  EXPECT_EQ(drive_intensity(1e300, 1e-300, 0.01, saturated), 1.0);
  EXPECT_TRUE(saturated);
  EXPECT_EQ(drive_intensity(5.0, 5.0, 0.01, saturated), 1.0);
  EXPECT_FALSE(saturated);
  EXPECT_EQ(drive_intensity(0.049, 5.0, 0.01, saturated), 0.0);
  EXPECT_GT(drive_intensity(0.051, 5.0, 0.01, saturated), 0.1);
  EXPECT_EQ(drive_intensity(0.0, 5.0, 0.0, saturated), 0.0);
  EXPECT_EQ(drive_intensity(-1.0, 5.0, 0.0, saturated), 0.0);
  EXPECT_FALSE(saturated);
}

TEST(LimitDrives, KeepsPowerAndSlewForAnyRequest) {
  Random random(7);
  constexpr double kRise = 1.0 / 40.0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Drive> drives(1 + static_cast<std::size_t>(random.below(8)));
    const double limit = std::pow(10.0, random.uniform(-1.0, 0.9));
    for (int sample = 0; sample < 500; ++sample) {
      if (random.uniform() < 0.05) {
        for (Drive& drive : drives) {
          drive.wanted = random.uniform() < 0.3 ? 0.0 : random.uniform();
          drive.max_fall = random.uniform() < 0.3 ? 1.0 / 400.0 : kRise;
        }
      }
      const std::vector<Drive> before = drives;
      limit_drives(drives, kRise, limit);
      double power = 0.0;
      for (std::size_t f = 0; f < drives.size(); ++f) {
        power += drives[f].intensity * drives[f].intensity;
        EXPECT_LE(drives[f].intensity - before[f].intensity, kRise + 1e-8);
        EXPECT_LE(before[f].intensity - drives[f].intensity, drives[f].max_fall + 1e-8);
        EXPECT_GE(drives[f].intensity, 0.0);
        EXPECT_LE(drives[f].intensity, 1.0);
      }
      EXPECT_LE(power, limit * (1.0 + 1e-7));
    }
  }
}

TEST(LimitDrives, ScalesAllAlikeAndReachesTheRequestInTime) {
  std::vector<Drive> drives(4);
  for (int sample = 0; sample < 40; ++sample) {
    for (std::size_t f = 0; f < 4; ++f) {
      drives[f].wanted = f < 2 ? 1.0 : 0.5;
      drives[f].max_fall = 1.0 / 40.0;
    }
    EXPECT_TRUE(limit_drives(drives, 1.0 / 40.0, 1.0));
  }
  EXPECT_NEAR(drives[0].intensity, 1.0 / std::sqrt(2.5), 1e-12);
  EXPECT_NEAR(drives[3].intensity, 0.5 / std::sqrt(2.5), 1e-12);
}

TEST(EvenShare, IsTheShareOfEqualFociUnderThePowerLimit) {
  EXPECT_EQ(even_share(1, 4.0), 1.0);
  EXPECT_EQ(even_share(4, 4.0), 1.0);
  EXPECT_EQ(even_share(8, 4.0), 0.5);
  for (const double limit : {0.3, 1.0, 2.5, 4.0, 8.0}) {
    for (int foci = 1; foci <= kMaxPaths; ++foci) {
      std::vector<Drive> drives(static_cast<std::size_t>(foci));
      for (Drive& drive : drives) drive.wanted = 1.0;
      limit_drives(drives, 1.0, limit);
      for (const Drive& drive : drives) {
        EXPECT_NEAR(drive.intensity * drive.intensity, even_share(foci, limit), 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace prostm
