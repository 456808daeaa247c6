#include "prostm/acoustics/field/flat_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

/// Returns a raster of some size with its middle at p_D, rotated by yaw about the vertical and then
/// tilted; its skin faces the array.
FlatRaster raster(int rows, int cols, double cell, const Vec3& middle, double yaw, double tilt) {
  const Eigen::Matrix3d axes =
      (Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(tilt, Vec3::UnitX()))
          .toRotationMatrix();
  FlatRaster out;
  out.rows = rows;
  out.cols = cols;
  out.right = cell * axes.col(0);
  out.down = cell * axes.col(1);
  out.normal = -axes.col(2);
  out.corner = middle - 0.5 * (cols - 1) * out.right - 0.5 * (rows - 1) * out.down;
  return out;
}

/// Returns the loop of one or two focal points that circle in the raster.
LoopDrives circling(const TransducerArray& array, const FlatRaster& flat, int samples,
                    Random& random) {
  LoopDrives out(static_cast<Eigen::Index>(array.position.size()), samples);
  const double radius = random.uniform(0.1, 0.45);
  const int foci = static_cast<int>(random.below(2)) + 1;
  const Medium air;
  for (int k = 0; k < samples; ++k) {
    std::vector<Vec3> points;
    for (int i = 0; i < foci; ++i) {
      const double a = 2.0 * kPi * (static_cast<double>(k) / samples + 0.5 * i);
      points.push_back(flat.at(flat.rows * (0.5 + radius * std::sin(a)),
                               flat.cols * (0.5 + radius * std::cos(a))));
    }
    const Propagation g = propagation_to(array, air, points);
    out.col(k) =
        (g.adjoint() * Eigen::VectorXcd::Ones(foci)).normalized().cast<std::complex<float>>();
  }
  return out;
}

SurfacePoints points_of(const FlatRaster& flat, const std::vector<std::size_t>& cells) {
  SurfacePoints out;
  for (const std::size_t cell : cells) {
    const auto width = static_cast<std::size_t>(flat.cols);
    out.p_D.push_back(
        flat.at(static_cast<double>(cell / width), static_cast<double>(cell % width)));
    out.normal.push_back(flat.normal);
  }
  return out;
}

/// Returns the largest difference, relative to the largest value.
double difference(const std::vector<float>& a, const std::vector<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  float worst = 0.0F;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return static_cast<double>(worst / *std::max_element(b.begin(), b.end()));
}

// Planes of any height, tilt and cell above two arrays, with holes in the skin.
TEST(FlatField, MatchesThePlainComputationAtEveryPoint) {
  WorkerPool pool(2);
  Random random(36);
  const Medium air;
  double worst = 0.0;
  int largest_step = 0;
  for (int trial = 0; trial < 24; ++trial) {
    const TransducerArray array = trial % 4 == 3 ? autd3_array() : usx_array();
    const PackedArray packed(array, air);
    const double cell = random.uniform(0.15e-3, 0.5e-3);
    const Vec3 middle(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04),
                      random.uniform(0.12, 0.3));
    const FlatRaster flat = raster(70 + static_cast<int>(random.below(30)), 80, cell, middle,
                                   random.uniform(-kPi, kPi), random.uniform(-0.5, 0.5));
    std::vector<std::size_t> cells;
    for (std::size_t c = 0; c < static_cast<std::size_t>(flat.rows * flat.cols); ++c) {
      if (random.below(8) != 0) cells.push_back(c);
    }
    const int samples = 24, frames = 6;
    const int step = flat_step(packed, flat, samples);
    largest_step = std::max(largest_step, step);
    const LoopBasis basis(packed, circling(array, flat, samples, random), pool);
    const LoopPressure fast = flat_loop_pressure(packed, air, basis, flat, cells, frames, pool);
    const LoopPressure plain =
        loop_pressure(packed, air, basis, points_of(flat, cells), frames, pool);
    for (const double error :
         {difference(fast.mean, plain.mean), difference(fast.envelope, plain.envelope),
          difference(fast.frame, plain.frame)}) {
      worst = std::max(worst, error);
      EXPECT_LT(error, 1e-5) << "trial " << trial << ", step " << step;
    }
  }
  std::printf("every %dth point at most; error up to %.1e of the largest pressure\n", largest_step,
              worst);
  EXPECT_GE(largest_step, 4);
}

TEST(FlatField, ComputesEveryPointWhereInterpolationIsInaccurateOrSlow) {
  const PackedArray packed(usx_array(), Medium());
  const auto step = [&](double cell, double height, std::size_t samples) {
    return flat_step(packed, raster(200, 200, cell, Vec3(0, 0, height), 0, 0), samples);
  };
  EXPECT_GT(step(0.2e-3, 0.2, 1000), 2);
  EXPECT_EQ(step(2e-3, 0.2, 1000), 1) << "large cells";
  EXPECT_EQ(step(0.2e-3, 0.04, 1000), 1) << "near the array";
  EXPECT_EQ(step(0.2e-3, 0.2, 1'000'000), 1) << "too many samples";
  EXPECT_EQ(flat_step(packed, raster(20, 20, 0.2e-3, Vec3(0, 0, 0.2), 0, 0), 1000), 1)
      << "few cells";
}

TEST(FlatField, DoesNotDependOnTheNumberOfThreads) {
  const Medium air;
  const TransducerArray array = usx_array();
  const PackedArray packed(array, air);
  const FlatRaster flat = raster(90, 90, 0.3e-3, Vec3(0.0, 0.0, 0.2), 0.3, 0.2);
  std::vector<std::size_t> cells(8100);
  std::iota(cells.begin(), cells.end(), std::size_t{0});
  Random random(1);
  const LoopDrives drives = circling(array, flat, 16, random);
  WorkerPool one(1), three(3);
  const LoopPressure a =
      flat_loop_pressure(packed, air, LoopBasis(packed, drives, one), flat, cells, 4, one);
  const LoopPressure b =
      flat_loop_pressure(packed, air, LoopBasis(packed, drives, three), flat, cells, 4, three);
  EXPECT_EQ(a.mean, b.mean);
  EXPECT_EQ(a.envelope, b.envelope);
  EXPECT_EQ(a.frame, b.frame);
  for (const int frames : {-1, 5}) {
    EXPECT_THROW(
        flat_loop_pressure(packed, air, LoopBasis(packed, drives, one), flat, cells, frames, one),
        std::invalid_argument);
  }
}

}  // namespace
}  // namespace prostm
