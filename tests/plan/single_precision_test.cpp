// Copies of a target in single precision, as in recordings by other programs.
#include <gtest/gtest.h>

#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm {
namespace {

/// Four bumps on a round dome of skin.
TargetField bumps(Random& random, double cell) {
  TargetField field;
  field.resize(38, 34);
  field.cell = cell;
  field.origin = Vec2(-0.0671234, -0.0712345);
  field.skin.assign(field.size(), 1);
  field.X_DP.translation() = Vec3(0.0, 0.0, 0.2);
  Vec2 centres[4];
  for (Vec2& c : centres) c = Vec2(random.uniform(-0.04, 0.04), random.uniform(-0.04, 0.04));
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t k = field.index(row, col);
      const Vec2 x = field.position(row, col);
      field.height[k] = 0.01 * std::exp(-x.squaredNorm() / 2e-3);
      for (const Vec2& c : centres)
        field.pressure[k] += 0.1 * std::exp(-(x - c).squaredNorm() / 2e-4);
      field.pressure[k] *= 1.0 + 0.05 * random.uniform();
      if (x.norm() < 0.07) continue;
      field.skin[k] = 0;
      field.pressure[k] = 0.0;
    }
  }
  return field;
}

TargetField in_single_precision(TargetField field) {
  const auto round = [](double& x) { x = static_cast<double>(static_cast<float>(x)); };
  for (double& p : field.pressure) round(p);
  for (double& z : field.height) round(z);
  round(field.cell);
  round(field.origin.x());
  round(field.origin.y());
  return field;
}

Plan plan_of(const TargetField& field, Preset preset) {
  PlanSettings settings;
  settings.preset = preset;
  Planner planner(settings, field.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
  return plan;
}

/// Largest distance between the points of two plans [m].
double apart(const Plan& a, const Plan& b) {
  if (a.paths.size() != b.paths.size()) return 1.0;
  double most = 0.0;
  for (std::size_t k = 0; k < a.paths.size(); ++k) {
    for (std::size_t i = 0; i < a.paths[k].points.size(); ++i)
      most = std::max(most, (a.paths[k].points[i] - b.paths[k].points[i]).norm());
  }
  return most;
}

TEST(SinglePrecision, DoesNotChangeThePathsOfFast) {
  Random random(7);
  for (const double cell : {4e-3, 5e-3, 5.2e-3, 20e-3 / 3.0, 7.8125e-3}) {
    for (int round = 0; round < 30; ++round) {
      const TargetField field = bumps(random, cell);
      const TargetField copy = in_single_precision(field);
      EXPECT_LT(apart(plan_of(field, Preset::Fast), plan_of(copy, Preset::Fast)), 0.1e-3)
          << cell << ", round " << round;
    }
  }
}

}  // namespace
}  // namespace prostm
