#include "prostm/acoustics/array/array.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

/// Returns the pressure of the focused array at p.
std::complex<double> focused_field(const TransducerArray& array, const Medium& air,
                                   const std::vector<double>& phases, const Vec3& p) {
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    sum += std::polar(1.0, phases[i]) * propagate(array, air, i, p);
  }
  return sum;
}

std::vector<double> phases_for(const TransducerArray& array, const Medium& air, const Vec3& focus) {
  std::vector<double> phases(array.position.size());
  focus_phases(array, air, focus, phases);
  return phases;
}

TEST(ArrayKinds, AreValidArraysOfTheirNames) {
  ASSERT_FALSE(array_kinds().empty());
  for (const ArrayKind& kind : array_kinds()) {
    const TransducerArray array = kind.make();
    EXPECT_EQ(array.name, kind.name);
    EXPECT_NO_THROW(validate(array)) << kind.name;
  }
}

TEST(Array, UsxIsACentredGridOf256) {
  const TransducerArray array = usx_array();
  ASSERT_EQ(array.position.size(), 256u);
  EXPECT_NO_THROW(validate(array));
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : array.position) sum += p;
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_NEAR((array.position[1] - array.position[0]).x(), 10.5e-3, 1e-15);
  EXPECT_NEAR((array.position[16] - array.position[0]).y(), 10.5e-3, 1e-15);
  EXPECT_NEAR((array.position[255] - array.position[0]).norm(), 15 * 10.5e-3 * std::sqrt(2.0),
              1e-12);
}

// 1/r from spreading, e^{−αr} from absorption in air.
TEST(Array, PressureFallsWithDistanceAndTurnsWithKr) {
  const TransducerArray array = usx_array();
  const Medium air;
  const double k = wave_number(array, air);
  EXPECT_NEAR(k, 2.0 * kPi * 40e3 / 343.2368, 1e-2);
  const Vec3 direction = Vec3(0.3, -0.2, 0.9).normalized();
  const std::complex<double> near = propagate(array, air, 7, array.position[7] + 0.1 * direction);
  for (const double r : {0.15, 0.2, 0.37}) {
    const std::complex<double> far = propagate(array, air, 7, array.position[7] + r * direction);
    const double left = std::exp(-air.absorption(40e3) * (r - 0.1));
    const std::complex<double> expected = std::polar(0.1 / r * left, k * (r - 0.1));
    EXPECT_LT(std::abs(far / near - expected), 1e-6 * std::abs(expected));
  }
  const Vec3 above = array.position[7] + Vec3(0.0, 0.0, 0.2);
  const double left = std::exp(-air.absorption(40e3) * 0.2);
  EXPECT_NEAR(left, 0.970, 0.0005);
  EXPECT_NEAR(std::abs(propagate(array, air, 7, above)), 3.4 / 0.2 * left, 1e-12);
  EXPECT_NEAR(std::abs(propagate(array, Wave{k, 0.0}, 7, above)), 3.4 / 0.2, 1e-12);
}

TEST(Array, FocusIsTheMaximumAlongTheThreeAxes) {
  const TransducerArray array = usx_array();
  const Medium air;
  Random random(3);
  for (int round = 0; round < 5; ++round) {
    // off the axis the largest pressure lies on the beam's axis, so x and y are checked there; z is
    // checked on the axis only, below the distance at which spreading shifts the maximum towards
    // the array
    const Vec3 focus(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03), 0.15);
    const auto phases = phases_for(array, air, focus);
    const double peak = std::abs(focused_field(array, air, phases, focus));
    for (int axis = 0; axis < 2; ++axis) {
      double best = 0.0, place = 0.0;
      for (double d = -0.03; d <= 0.03; d += 0.5e-3) {
        const double p = std::abs(focused_field(array, air, phases, focus + d * Vec3::Unit(axis)));
        if (p > best) best = p, place = d;
      }
      EXPECT_LE(std::abs(place), 0.6e-3) << "axis " << axis;
      EXPECT_LE(best, 1.01 * peak);
    }
    double best = 0.0, place = 0.0;
    for (double d = -0.05; d <= 0.05; d += 1e-3) {
      const double p = std::abs(focused_field(array, air, phases, focus + Vec3(0.0, 0.0, d)));
      if (p > best) best = p, place = d;
    }
    EXPECT_LE(std::abs(place), 10e-3);
  }
}

TEST(Array, FocusWidthFollowsFromTheAperture) {
  const TransducerArray array = usx_array();
  const Medium air;
  const double wavelength = air.speed_of_sound() / array.frequency;
  const double aperture = 16 * 10.5e-3;
  for (const double z : {0.2, 0.25, 0.3}) {
    const Vec3 focus(0.0, 0.0, z);
    const auto phases = phases_for(array, air, focus);
    const double peak = std::abs(focused_field(array, air, phases, focus));
    // (A6)
    double half = 0.0;
    while (std::abs(focused_field(array, air, phases, focus + Vec3(half, 0.0, 0.0))) > 0.5 * peak) {
      half += 0.02e-3;
    }
    const double sine = 0.5 * aperture / std::hypot(z, 0.5 * aperture);
    const double expected = 0.6034 * wavelength / (2.0 * sine);
    EXPECT_NEAR(half, expected, 0.05 * expected) << "z = " << z;
  }
}

TEST(Array, FieldHasTheSymmetryOfTheArray) {
  const TransducerArray array = usx_array();
  const Medium air;
  const auto phases = phases_for(array, air, Vec3(0.0, 0.0, 0.2));
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05);
    const double p = std::abs(focused_field(array, air, phases, Vec3(x, y, 0.18)));
    for (const Vec3& other : {Vec3(-x, y, 0.18), Vec3(x, -y, 0.18), Vec3(y, x, 0.18)}) {
      EXPECT_NEAR(std::abs(focused_field(array, air, phases, other)), p, 1e-7 * (1.0 + p));
    }
  }
}

TEST(Array, RadiationPressureIsQuadraticInThePressure) {
  const Medium air;
  const double c = air.speed_of_sound();
  EXPECT_NEAR(radiation_pressure(1000.0, air), 2e6 / (air.density() * c * c), 1e-12);
  EXPECT_NEAR(radiation_pressure(2000.0, air), 4.0 * radiation_pressure(1000.0, air), 1e-12);
  EXPECT_EQ(radiation_pressure(0.0, air), 0.0);
}

}  // namespace
}  // namespace prostm
