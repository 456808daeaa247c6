#include "prostm/emit/compensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/units.hpp"
#include "prostm/target/skin_normal.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

/// Returns 100 × 100 mm of skin in 5 mm cells with this slope along x.
TargetFrame slope(double rise) {
  TargetFrame frame;
  frame.patches.emplace_back();
  TargetField& field = frame.patches.back();
  field.cell = 5e-3;
  field.origin = Vec2(-0.05, -0.05);
  field.resize(21, 21);
  for (int row = 0; row < 21; ++row) {
    for (int col = 0; col < 21; ++col) {
      field.skin[field.index(row, col)] = 1;
      field.height[field.index(row, col)] = rise * field.position(row, col).x();
    }
  }
  return frame;
}

LiftedPlan lifted(const TargetFrame& frame) {
  Plan plan;
  plan.paths.emplace_back();
  for (int i = 0; i < 12; ++i) {
    const double a = 2.0 * kPi * i / 12.0;
    plan.paths[0].points.emplace_back(0.02 * std::cos(a), 0.02 * std::sin(a));
    plan.paths[0].pressure.push_back(1.0);
  }
  LiftedPlan out;
  lift(plan, frame, out);
  return out;
}

TEST(SkinNormal, FollowsTheSlopeAndIsLevelForIsolatedSkin) {
  TargetFrame frame = slope(std::tan(0.5));
  TargetField& field = frame.patches[0];
  const Vec3 expected(std::sin(0.5), 0.0, -std::cos(0.5));
  EXPECT_LT((skin_normal(field, 10, 10) - expected).norm(), 1e-6);
  EXPECT_LT((skin_normal(field, 0, 20) - expected).norm(), 1e-6);
  std::fill(field.skin.begin(), field.skin.end(), std::uint8_t{0});
  EXPECT_LT((skin_normal(field, 10, 10) + Vec3::UnitZ()).norm(), 1e-12);
  field.skin[field.index(10, 10)] = 1;  // isolated
  EXPECT_LT((skin_normal(field, 10, 10) + Vec3::UnitZ()).norm(), 1e-6);
  for (int row = 0; row < 21; ++row) field.skin[field.index(row, 10)] = 1;  // a strip across it
  EXPECT_LT((skin_normal(field, 10, 10) + Vec3::UnitZ()).norm(), 1e-6);
}

TEST(TiltFactor, InvertsTheSquaredCosineUpToItsBound) {
  const Vec3 p(0.03, -0.02, 0.2);
  const Vec3 across = p.unitOrthogonal();
  for (const double beta : {0.0, 0.2, 0.6, 0.8, 1.2, 1.57, 2.0, 3.1}) {
    const Vec3 normal = Eigen::AngleAxisd(beta, across) * -p.normalized();
    const double cosine = std::max(std::cos(beta), 0.0);
    const double factor = tilt_factor(p, normal, 2.0);
    EXPECT_LE(factor, 2.0);
    EXPECT_GE(factor, 1.0 - 1e-12);
    EXPECT_NEAR(factor, cosine * cosine > 0.5 ? 1.0 / (cosine * cosine) : 2.0, 1e-9);
    EXPECT_EQ(tilt_factor(p, normal, 1.0), 1.0);
  }
}

TEST(CompensateTilt, RaisesPressureOnASlopeWithoutAllocation) {
  const TargetFrame frame = slope(std::tan(0.6));
  const LiftedPlan before = lifted(frame);
  LiftedPlan after = before;
  compensate_tilt(after, frame, 1.0);
  for (std::size_t i = 0; i < before.paths[0].pressure.size(); ++i) {
    EXPECT_EQ(after.paths[0].pressure[i], before.paths[0].pressure[i]);
  }
  {
    const test::HeapGuard guard;
    compensate_tilt(after, frame, 2.0);
    EXPECT_EQ(guard.allocations(), 0u);
  }
  const Vec3 normal(std::sin(0.6), 0.0, -std::cos(0.6));
  for (std::size_t i = 0; i < before.paths[0].pressure.size(); ++i) {
    const double factor = tilt_factor(before.paths[0].p_D[i], normal, 2.0);
    EXPECT_NEAR(after.paths[0].pressure[i], factor * before.paths[0].pressure[i], 1e-6);
    EXPECT_GT(factor, 1.1);
  }
}

}  // namespace
}  // namespace prostm
