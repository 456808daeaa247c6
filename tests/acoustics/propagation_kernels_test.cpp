#include "prostm/acoustics/field/propagation_kernels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Rows = void (*)(const PackedArray&, std::span<const Vec3>, std::span<const Vec3>, float*,
                      float*);

struct Matrix {
  std::vector<float> re, im;
};

Matrix rows_of(Rows rows, const PackedArray& packed, std::span<const Vec3> points,
               std::span<const Vec3> normals = {}) {
  Matrix g;
  g.re.assign(points.size() * packed.stride(), -1.0F);
  g.im = g.re;
  rows(packed, points, normals, g.re.data(), g.im.data());
  return g;
}

Vec3 random_direction(Random& random) {
  return Vec3(random.normal(), random.normal(), random.normal()).normalized();
}

/// Returns points in all directions at distances up to `reach`, none on a transducer.
std::vector<Vec3> points_around(const TransducerArray& array, double reach, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  while (points.size() < 200) {
    const Vec3 p = random.uniform(0.02, reach) * random_direction(random);
    const bool clear = std::all_of(array.position.begin(), array.position.end(),
                                   [&](const Vec3& t) { return (p - t).norm() > 0.01; });
    if (clear) points.push_back(p);
  }
  return points;
}

/// Returns the largest |ours − (A1)| relative to the array's on-axis value at that distance.
double worst_error(const PackedArray& packed, const Matrix& g, std::span<const Vec3> points,
                   std::span<const Vec3> normals = {}) {
  double worst = 0.0;
  for (std::size_t m = 0; m < points.size(); ++m) {
    for (std::size_t n = 0; n < packed.transducers(); ++n) {
      const Vec3 way = points[m] - packed.array.position[n];
      const double r = way.norm();
      // at 90°, up to rounding, either side of the table's last step is correct
      if (std::abs(way.dot(packed.array.normal[n])) < 1e-6 * r) continue;
      std::complex<double> expected = propagate(packed.array, packed.wave, n, points[m]);
      if (!normals.empty()) expected *= std::max(-way.dot(normals[m]) / r, 0.0);
      const std::size_t at = m * packed.stride() + n;
      const std::complex<double> got = std::complex<float>(g.re[at], g.im[at]);
      worst = std::max(worst, std::abs(got - expected) * r /
                                  (packed.array.amplitude * std::exp(-packed.wave.absorption * r)));
    }
  }
  return worst;
}

TransducerArray turned_omni() {
  TransducerArray array = usx_array();
  array.directivity = Directivity::Omni;
  Random random(5);
  for (Vec3& n : array.normal) n = random_direction(random);
  return array;
}

// 0.5 m is 366 rad at 40 kHz.
TEST(PropagationKernels, EveryElementMatchesA1) {
  for (const TransducerArray& array : {usx_array(), autd3_array(), turned_omni()}) {
    const PackedArray packed(array, Medium());
    for (const double reach : {0.5, 10.0}) {
      const std::vector<Vec3> points = points_around(array, reach, 7);
      EXPECT_LT(worst_error(packed, rows_of(propagation_rows, packed, points), points), 1e-6)
          << array.name << ' ' << reach;
      EXPECT_LT(worst_error(packed, rows_of(propagation_rows_plain, packed, points), points), 1e-7);
    }
  }
}

TEST(PropagationKernels, SinglePrecisionRowsAreNearlyTheSame) {
  for (const TransducerArray& array : {usx_array(), autd3_array(), turned_omni()}) {
    const PackedArray packed(array, Medium());
    const std::vector<Vec3> points = points_around(array, 1.0, 15);
    Matrix g = rows_of(propagation_rows_plain, packed, points);
    for (std::size_t m = 0; m < points.size(); ++m) {
      const std::size_t at = m * packed.stride();
      propagation_row_in_single(packed, points[m], g.re.data() + at, g.im.data() + at);
    }
    EXPECT_LT(worst_error(packed, g, points), 2e-4) << array.name;
  }
}

TEST(PropagationKernels, IndividualNormalsGiveTheSame) {
  Random random(11);
  TransducerArray array = usx_array();
  for (Vec3& n : array.normal) n = random_direction(random);
  const PackedArray packed(array, Medium());
  const std::vector<Vec3> points = points_around(array, 0.5, 8);
  EXPECT_LT(worst_error(packed, rows_of(propagation_rows, packed, points), points), 1e-6);
}

// For two arrays 2 m apart, absorption differs from transducer to transducer.
TEST(PropagationKernels, DistantArraysGiveTheSame) {
  Pose X_DA = Pose::Identity();
  X_DA.translation() = Vec3(2.0, 0.3, 0.1);
  const TransducerArray both =
      join(std::vector<TransducerArray>{usx_array(), place(usx_array(), X_DA)});
  const PackedArray packed(both, Medium());
  ASSERT_GT(packed.wave.absorption * packed.reach, 0.1);
  const std::vector<Vec3> points = points_around(both, 1.0, 13);
  EXPECT_LT(worst_error(packed, rows_of(propagation_rows, packed, points), points), 1e-6);
}

// Beyond the polynomial's range the table is used.
TEST(PropagationKernels, WidePistonsAreAsAccurateAsTheirTable) {
  for (const double radius : {4.5e-3, 10e-3, 20e-3, 50e-3}) {
    TransducerArray array = usx_array();
    array.radius = radius;
    const PackedArray packed(array, Medium());
    EXPECT_EQ(packed.beam == PackedArray::Beam::Polynomial, radius < 6e-3) << radius;
    const double ka = packed.wave.number * radius;
    const std::vector<Vec3> points = points_around(array, 0.5, 14);
    EXPECT_LT(worst_error(packed, rows_of(propagation_rows, packed, points), points),
              std::max(1e-6, 1.5e-8 * ka * ka))
        << radius;
  }
}

// (A20); the back of the surface receives nothing.
TEST(PropagationKernels, SurfaceNormalsWeightByTheCosineOfIncidence) {
  const PackedArray packed(usx_array(), Medium());
  const std::vector<Vec3> points = points_around(packed.array, 0.5, 9);
  Random random(10);
  std::vector<Vec3> normals;
  for (std::size_t m = 0; m < points.size(); ++m) normals.push_back(random_direction(random));
  for (const Rows rows : {propagation_rows, propagation_rows_plain}) {
    const Matrix g = rows_of(rows, packed, points, normals);
    EXPECT_LT(worst_error(packed, g, points, normals), 1e-6);
    EXPECT_GT(std::count(g.re.begin(), g.re.end(), 0.0F), 1000);
  }
}

// 1/r and phase along the axis of one transducer, without the reference.
TEST(PropagationKernels, OneTransducerFallsAsOneOverRWithPhaseKr) {
  TransducerArray array = usx_array();
  array.position = {Vec3::Zero()};
  array.normal = {Vec3::UnitZ()};
  PackedArray packed(array, Medium());
  packed.wave.absorption = 0.0;
  std::vector<Vec3> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(0.0, 0.0, 0.1 + 0.8e-3 * i);
  const Matrix g = rows_of(propagation_rows, packed, points);
  for (std::size_t m = 0; m < points.size(); ++m) {
    const double r = points[m].z();
    const std::complex<double> p =
        std::complex<float>(g.re[m * packed.stride()], g.im[m * packed.stride()]);
    EXPECT_NEAR(std::abs(p) * r / array.amplitude, 1.0, 1e-6);
    EXPECT_NEAR(std::arg(p * std::polar(1.0, -packed.wave.number * r)), 0.0, 1e-6);
  }
}

TEST(PropagationKernels, RowsArePaddedWithZeros) {
  const PackedArray packed(autd3_array(), Medium());
  ASSERT_EQ(packed.transducers(), 249u);
  ASSERT_EQ(packed.stride(), 256u);
  const std::vector<Vec3> points = {Vec3(0.01, 0.02, 0.2)};
  for (const Rows rows : {propagation_rows, propagation_rows_plain}) {
    const Matrix g = rows_of(rows, packed, points);
    for (std::size_t n = 249; n < 256; ++n) {
      EXPECT_EQ(g.re[n], 0.0F);
      EXPECT_EQ(g.im[n], 0.0F);
    }
  }
}

// A point's row does not depend on the other points requested.
TEST(PropagationKernels, RowsAreIndependent) {
  const PackedArray packed(usx_array(), Medium());
  const std::vector<Vec3> points = points_around(packed.array, 0.4, 12);
  const Matrix all = rows_of(propagation_rows, packed, points);
  const Matrix one = rows_of(propagation_rows, packed, std::span(points).subspan(17, 1));
  EXPECT_TRUE(std::equal(one.re.begin(), one.re.end(),
                         all.re.begin() + static_cast<std::ptrdiff_t>(17 * packed.stride())));
}

}  // namespace
}  // namespace prostm
