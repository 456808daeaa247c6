#include "prostm/acoustics/field/loop_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "prostm/acoustics/field/detail/complex_product.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using Complex = std::complex<double>;

/// Returns a raster of side² points, 3 mm apart, on a plane 200 mm above the array, turned about x
/// by `tilt` [rad].
SurfacePoints raster(int side, double tilt = 0.0) {
  SurfacePoints out;
  const Eigen::AngleAxisd turn(tilt, Vec3::UnitX());
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const Vec3 in_plane(3e-3 * (i - 0.5 * (side - 1)), 3e-3 * (j - 0.5 * (side - 1)), 0.0);
      out.p_D.push_back(Vec3(0.0, 0.0, 0.2) + turn * in_plane);
      out.normal.push_back(turn * -Vec3::UnitZ());
    }
  }
  return out;
}

Eigen::VectorXcf focused(const TransducerArray& array, const Vec3& focus) {
  std::vector<double> phases(array.position.size());
  focus_phases(array, Medium(), focus, phases);
  Eigen::VectorXcf q(static_cast<Eigen::Index>(phases.size()));
  for (std::size_t n = 0; n < phases.size(); ++n) {
    q[static_cast<Eigen::Index>(n)] = std::complex<float>(std::polar(1.0, phases[n]));
  }
  return q;
}

/// Returns drives for two superposed focal points on circles of 15 and 8 mm.
LoopDrives two_circles(const TransducerArray& array, int samples) {
  LoopDrives drives(static_cast<Eigen::Index>(array.position.size()), samples);
  for (int k = 0; k < samples; ++k) {
    const double a = 2.0 * kPi * k / samples;
    drives.col(k) = 0.5F * focused(array, Vec3(0.015 * std::cos(a), 0.015 * std::sin(a), 0.2)) +
                    0.3F * focused(array, Vec3(0.02 + 0.008 * std::cos(2.0 * a),
                                               -0.02 + 0.008 * std::sin(2.0 * a), 0.2));
  }
  return drives;
}

LoopDrives random_drives(int transducers, int samples, std::uint64_t seed) {
  Random random(seed);
  LoopDrives drives(transducers, samples);
  for (Eigen::Index i = 0; i < drives.size(); ++i) {
    drives.data()[i] = {static_cast<float>(random.normal()), static_cast<float>(random.normal())};
  }
  return drives;
}

/// Computes (A20) of every sample by `propagate`, points × samples.
Eigen::MatrixXd direct(const TransducerArray& array, const LoopDrives& drives,
                       const SurfacePoints& surface) {
  const Medium air;
  const Wave sound = wave(array, air);
  Eigen::MatrixXcd g(static_cast<Eigen::Index>(surface.p_D.size()), drives.rows());
  for (std::size_t m = 0; m < surface.p_D.size(); ++m) {
    for (std::size_t n = 0; n < array.position.size(); ++n) {
      const double cosine =
          -(surface.p_D[m] - array.position[n]).normalized().dot(surface.normal[m]);
      g(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) =
          std::max(cosine, 0.0) * propagate(array, sound, n, surface.p_D[m]);
    }
  }
  return radiation_pressure(1.0, air) * (g * drives.cast<Complex>()).cwiseAbs2();
}

double worst(const std::vector<float>& ours, const Eigen::VectorXd& expected) {
  const Eigen::VectorXd got =
      Eigen::Map<const Eigen::VectorXf>(ours.data(), expected.size()).cast<double>();
  return (got - expected).cwiseAbs().maxCoeff() / expected.maxCoeff();
}

TEST(ComplexProduct, KernelsMatchPlainSums) {
  Random random(3);
  for (const std::size_t rows : {1u, 3u, 7u, 48u}) {
    for (const std::size_t cols : {1u, 16u, 37u}) {
      const std::size_t inner = 40;
      std::vector<float> re(rows * inner), im(re.size());
      for (float& x : re) x = static_cast<float>(random.normal());
      for (float& x : im) x = static_cast<float>(random.normal());
      PackedMatrix y(inner, cols);
      for (std::size_t k = 0; k < inner; ++k) {
        for (std::size_t c = 0; c < cols; ++c) {
          y.set(k, c, {static_cast<float>(random.normal()), static_cast<float>(random.normal())});
        }
      }
      const std::size_t first = y.cols() > 16 ? 1 : 0;
      std::vector<float> a(rows * y.cols(), -7.0F), b = a, c = a, d = a;
      complex_product({re.data(), im.data(), rows, inner}, y, first, a.data(), b.data());
      complex_product_plain({re.data(), im.data(), rows, inner}, y, first, c.data(), d.data());
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_NEAR(a[i], c[i], 3e-5);
        EXPECT_NEAR(b[i], d[i], 3e-5);
      }
      std::vector<float> power(y.cols());
      squares(a.data(), b.data(), y.cols(), 0.5F, power.data());
      double sum = 0.0;
      for (std::size_t i = 0; i < y.cols(); ++i) {
        EXPECT_NEAR(power[i], 0.5F * (a[i] * a[i] + b[i] * b[i]), 1e-4F);
        sum += 2.0 * static_cast<double>(power[i]);
      }
      EXPECT_NEAR(sum_of_squares(a.data(), b.data(), y.cols()), sum, 1e-5 * sum);
    }
  }
}

TEST(DriveBasis, IsAFactorOfTheCovariance) {
  WorkerPool pool(2);
  const LoopDrives drives = random_drives(60, 500, 4);
  const Eigen::MatrixXcf factor = covariance_factor(drives, pool, 1e-6);
  EXPECT_EQ(factor.cols(), 60);  // noise has all degrees of freedom
  const Eigen::MatrixXcd a = drives.cast<Complex>(), l = factor.cast<Complex>();
  const Eigen::MatrixXcd c = a * a.adjoint() / 500.0;
  EXPECT_LT((l * l.adjoint() - c).cwiseAbs().maxCoeff(), 1e-5 * c.cwiseAbs().maxCoeff());
}

TEST(DriveBasis, LeavesNoMoreThanTheTolerance) {
  WorkerPool pool(1);
  const TransducerArray array = usx_array();
  const LoopDrives drives = two_circles(array, 400);
  const Eigen::MatrixXcf q = orthonormal(covariance_factor(drives, pool, 1e-6));
  EXPECT_GT(q.cols(), 10);
  EXPECT_LT(q.cols(), 80);
  EXPECT_LT((q.adjoint() * q - Eigen::MatrixXcf::Identity(q.cols(), q.cols())).norm(), 1e-4F);
  const Eigen::MatrixXcf left = drives - q * (q.adjoint() * drives);
  EXPECT_LT(left.squaredNorm(), 1e-6F * drives.squaredNorm());
}

TEST(DriveBasis, SilenceHasAnEmptyBasis) {
  WorkerPool pool(1);
  EXPECT_EQ(covariance_factor(LoopDrives::Zero(8, 5), pool, 1e-6).cols(), 0);
}

TEST(DriveBasis, RejectsInvalidLoops) {
  WorkerPool pool(1);
  const auto refused = [&](const LoopDrives& drives, double tolerance) {
    EXPECT_THROW(covariance_factor(drives, pool, tolerance), std::invalid_argument);
  };
  refused(LoopDrives(), 1e-6);
  LoopDrives drives = random_drives(4, 4, 1);
  refused(drives, 1e-8);
  drives(1, 2) = std::numeric_limits<float>::quiet_NaN();
  refused(drives, 1e-6);
  drives(1, 2) = 2e6F;
  refused(drives, 1e-6);
}

// The pressure is 0 everywhere, without a division by zero.
TEST(LoopField, SilenceGivesNoPressure) {
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(1);
  const LoopPressure loop = loop_pressure(
      packed, Medium(), LoopBasis(packed, LoopDrives::Zero(256, 8), pool), raster(3), 4, pool);
  EXPECT_EQ(loop.mean, std::vector<float>(9, 0.0F));
  EXPECT_EQ(loop.envelope, loop.mean);
}

TEST(LoopField, MatchesEachSampleComputedAlone) {
  WorkerPool pool(2);
  for (const TransducerArray& array : {usx_array(), autd3_array()}) {
    const PackedArray packed(array, Medium());
    for (const double tilt : {0.0, 0.6}) {
      const SurfacePoints surface = raster(13, tilt);
      const LoopDrives drives = two_circles(array, 120);
      const Eigen::MatrixXd expected = direct(array, drives, surface);
      EXPECT_LT(worst(mean_radiation_pressure(packed, Medium(), drives, surface, pool),
                      expected.rowwise().mean()),
                1e-5);
      const LoopPressure loop =
          loop_pressure(packed, Medium(), LoopBasis(packed, drives, pool), surface, 30, pool);
      EXPECT_LT(worst(loop.mean, expected.rowwise().mean()), 1e-5);
      EXPECT_LT(worst(loop.envelope, expected.rowwise().maxCoeff()), 2e-4);
      ASSERT_EQ(loop.frame.size(), 30u * surface.p_D.size());
      Eigen::VectorXd parts(30 * expected.rows());
      for (Eigen::Index i = 0; i < parts.size(); ++i) {
        parts[i] = expected.row(i / 30).segment(4 * (i % 30), 4).mean();
      }
      EXPECT_LT(worst(loop.frame, parts), 2e-4);
    }
  }
}

// Unstructured drives have full rank: the computation is slower, but still correct.
TEST(LoopField, IsCorrectForDrivesOfFullRank) {
  WorkerPool pool(2);
  const TransducerArray array = usx_array();
  const PackedArray packed(array, Medium());
  const SurfacePoints surface = raster(7);
  const LoopDrives drives = random_drives(256, 300, 9);
  const Eigen::MatrixXd expected = direct(array, drives, surface);
  EXPECT_LT(worst(mean_radiation_pressure(packed, Medium(), drives, surface, pool),
                  expected.rowwise().mean()),
            1e-4);
}

TEST(LoopField, DoesNotDependOnTheNumberOfThreads) {
  const PackedArray packed(usx_array(), Medium());
  const SurfacePoints surface = raster(20, 0.3);
  const LoopDrives drives = two_circles(packed.array, 100);
  WorkerPool one(1), three(3);
  const LoopPressure a =
      loop_pressure(packed, Medium(), LoopBasis(packed, drives, one), surface, 10, one);
  const LoopPressure b =
      loop_pressure(packed, Medium(), LoopBasis(packed, drives, three), surface, 10, three);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.envelope, b.envelope);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(mean_radiation_pressure(packed, Medium(), drives, surface, one),
            mean_radiation_pressure(packed, Medium(), drives, surface, three));
}

// Far from a single transducer the wave is plane: cos² of the angle of incidence.
TEST(LoopField, APlaneWavePressesWithTheSquaredCosine) {
  TransducerArray array = usx_array();
  array.position = {Vec3::Zero()};
  array.normal = {Vec3::UnitZ()};
  const PackedArray packed(array, Medium());
  WorkerPool pool(1);
  const Vec3 p(0.0, 0.0, 0.4);
  const double facing = radiation_pressure(std::abs(propagate(array, Medium(), 0, p)), Medium());
  for (const double tilt : {0.0, 0.3, 0.7, 1.2, 1.5, 2.0, 3.0}) {
    const SurfacePoints surface{{p}, {Eigen::AngleAxisd(tilt, Vec3::UnitY()) * -Vec3::UnitZ()}};
    const float got =
        mean_radiation_pressure(packed, Medium(), LoopDrives::Ones(1, 2), surface, pool)[0];
    const double cosine = std::max(std::cos(tilt), 0.0);
    EXPECT_NEAR(got, facing * cosine * cosine, 1e-6 * facing) << tilt;
  }
}

// Radiation pressure of a focus on a level surface and on one tilted by 40°, relative to (A5).
TEST(LoopField, AFocusPressesLessOnATiltedSurface) {
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(1);
  const Vec3 focus(0.0, 0.0, 0.2);
  const Eigen::VectorXcf q = focused(packed.array, focus);
  const double facing = radiation_pressure(
      static_cast<double>(std::abs(acoustic_pressure(packed, std::vector{focus}, q)[0])), Medium());
  const auto share = [&](double tilt) {
    const SurfacePoints surface{{focus}, {Eigen::AngleAxisd(tilt, Vec3::UnitX()) * -Vec3::UnitZ()}};
    return static_cast<double>(mean_radiation_pressure(packed, Medium(), q, surface, pool)[0]) /
           facing;
  };
  EXPECT_NEAR(share(0.0), 0.90, 0.01);
  EXPECT_NEAR(share(40.0 * kPi / 180.0), 0.53, 0.01);
}

TEST(LoopField, RejectsInvalidInput) {
  const PackedArray packed(usx_array(), Medium());
  WorkerPool pool(1);
  const LoopDrives drives = two_circles(packed.array, 6);
  const auto refused = [&](const SurfacePoints& surface) {
    EXPECT_THROW(mean_radiation_pressure(packed, Medium(), drives, surface, pool),
                 std::invalid_argument);
  };
  refused({});
  SurfacePoints surface = raster(2);
  surface.normal.pop_back();
  refused(surface);
  surface = raster(2);
  surface.normal[1] *= 1.1;
  refused(surface);
  surface = raster(2);
  surface.p_D[3].x() = std::numeric_limits<double>::infinity();
  refused(surface);
  surface = raster(2);
  surface.p_D[0] = packed.array.position[40] + Vec3(0.0, 0.0, 5e-3);
  refused(surface);
  EXPECT_THROW(mean_radiation_pressure(packed, Medium(), drives.topRows(10), raster(2), pool),
               std::invalid_argument);
  EXPECT_THROW(loop_pressure(packed, Medium(), LoopBasis(packed, drives, pool), raster(2), 4, pool),
               std::invalid_argument);
}

}  // namespace
}  // namespace prostm
