#include "prostm/fluid/fluid_pressure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

const GridShape kGrid{24, 20, 16, 0.01, Vec3(-0.12, -0.1, 0.02)};
const Vec3 kDown = -Vec3::UnitZ();

/// A pressure linear in space, so that values between cells are known [Pa].
double linear(const Vec3& p) {
  return 0.3 + 2.0 * p.x() - 1.5 * p.y() + 4.0 * p.z();
}

std::vector<float> field(double factor = 1.0) {
  std::vector<float> out(kGrid.cell_count());
  for (int k = 0; k < kGrid.nz; ++k) {
    for (int j = 0; j < kGrid.ny; ++j) {
      for (int i = 0; i < kGrid.nx; ++i) {
        out[kGrid.cell_index(i, j, k)] =
            static_cast<float>(factor * linear(kGrid.cell_centre(i, j, k)));
      }
    }
  }
  return out;
}

double at(const FluidPressure& pressure, const Vec3& p) {
  double out = 0.0;
  pressure.sample({&p, 1}, kDown, {&out, 1});
  return out;
}

TEST(FluidPressure, IsReadOutsideTheSkin) {
  const std::vector<float> given = field();
  const std::vector<std::uint8_t> free(kGrid.cell_count(), 1);
  Random random(3);
  for (const double offset : {0.005, 0.010, 0.025}) {
    FluidPressureSettings settings;
    settings.offset = offset;
    FluidPressure pressure(settings, kGrid);
    pressure.take(given, free, 0.02);
    for (int n = 0; n < 10'000; ++n) {
      const Vec3 p(random.uniform(-0.1, 0.1), random.uniform(-0.08, 0.08),
                   random.uniform(0.06, 0.16));
      ASSERT_NEAR(at(pressure, p), linear(p + offset * kDown), 1e-6);
    }
  }
}

TEST(FluidPressure, IgnoresCellsInAHandAndIsZeroFarFromAir) {
  std::vector<float> given = field();
  std::vector<std::uint8_t> free(kGrid.cell_count(), 1);
  for (int k = 8; k < kGrid.nz; ++k) {
    for (int j = 0; j < kGrid.ny; ++j) {
      for (int i = 0; i < kGrid.nx; ++i) {
        free[kGrid.cell_index(i, j, k)] = 0;
        given[kGrid.cell_index(i, j, k)] = 1e6F;
      }
    }
  }
  FluidPressureSettings settings;
  settings.offset = kGrid.cell;
  FluidPressure pressure(settings, kGrid);
  pressure.take(given, free, 0.02);
  // half-way between the last layer of air and the first in the hand: only the air's value counts
  const Vec3 between(0.0, 0.0, kGrid.p_DF.z() + 8.0 * kGrid.cell);
  const Vec3 last(0.0, 0.0, kGrid.p_DF.z() + 7.5 * kGrid.cell);
  EXPECT_NEAR(at(pressure, between - kGrid.cell * kDown), linear(last), 1e-6);
  EXPECT_EQ(at(pressure, Vec3(0.0, 0.0, 0.16)), 0.0);
  EXPECT_EQ(at(pressure, Vec3(1.0, 0.0, 0.1)), 0.0);
}

TEST(FluidPressure, FollowsAStepInTimeAsAnExponential) {
  const std::vector<float> before = field(), after = field(3.0);
  const std::vector<std::uint8_t> free(kGrid.cell_count(), 1);
  FluidPressureSettings settings;
  settings.time_constant = 0.1;
  settings.offset = kGrid.cell;
  FluidPressure pressure(settings, kGrid);
  const Vec3 p(0.01, 0.02, 0.1);
  const double level = linear(p + kGrid.cell * kDown);
  pressure.take(before, free, 0.02);
  EXPECT_NEAR(at(pressure, p), level, 1e-6) << "a newly known value has no history";
  for (int n = 1; n <= 20; ++n) {
    const test::HeapGuard guard;
    pressure.take(after, free, 0.02);
    EXPECT_EQ(guard.allocations(), 0U);
    EXPECT_NEAR(at(pressure, p), level * (3.0 - 2.0 * std::exp(-0.02 * n / 0.1)), 1e-5);
  }
}

TEST(FluidPressure, RejectsBadSettings) {
  FluidPressureSettings s;
  s.offset = 0.0;
  EXPECT_THROW(FluidPressure(s, kGrid), std::invalid_argument);
  s = {};
  s.time_constant = -1.0;
  EXPECT_THROW(FluidPressure(s, kGrid), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
