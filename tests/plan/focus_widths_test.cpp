#include "prostm/plan/focus_widths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

/// σ = 2 mm + 10 mm/m · height + 3 mm/m · offset + 1 mm/rad · tilt: linear interpolation is exact.
double linear(double height, double offset, double tilt) {
  return 2e-3 + 10e-3 * height + 3e-3 * offset + 1e-3 * tilt;
}

FocusWidths table() {
  FocusWidths out;
  out.height = {0.1, 0.17, 0.3};
  out.offset = {0.0, 0.05};
  out.tilt = {0.0, 0.4, 1.0, 1.2};
  for (const double h : out.height) {
    for (const double x : out.offset) {
      for (const double t : out.tilt) out.sigma.push_back(linear(h, x, t));
    }
  }
  return out;
}

FocusWidths constant(double sigma) {
  return {{0.1, 0.3}, {0.0}, {0.0}, {sigma, sigma}};
}

TEST(FocusWidths, AreLinearBetweenEntriesAndConstantBeyondThem) {
  const FocusWidths widths = table();
  validate(widths);
  Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const double h = random.uniform(0.0, 0.5), x = random.uniform(0.0, 0.1),
                 t = random.uniform(0.0, 1.6);
    const double expected = linear(std::clamp(h, 0.1, 0.3), std::min(x, 0.05), std::min(t, 1.2));
    ASSERT_NEAR(widths.at(h, x, t), expected, 1e-12) << h << ' ' << x << ' ' << t;
  }
}

TEST(FocusWidths, OfATargetAreThoseAtItsPressure) {
  TargetField field = fields::make(fields::Pattern::Fingertips, 0, 40);
  Vec2 middle = Vec2::Zero();
  double sum = 0.0;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t cell = field.index(row, col);
      field.height[cell] = 0.01;
      if (field.skin[cell] == 0) continue;
      middle += field.pressure[cell] * field.position(row, col);
      sum += field.pressure[cell];
    }
  }
  field.X_DP = Eigen::Translation3d(0.0, 0.0, 0.15) * Eigen::AngleAxisd(0.3, Vec3::UnitY());
  const Vec3 p = field.X_DP * Vec3(middle.x() / sum, middle.y() / sum, 0.01);
  const double offset = std::min(p.head<2>().norm(), 0.05);  // the table ends there
  EXPECT_NEAR(table().on(field), linear(p.z(), offset, 0.3), 1e-9);
  std::fill(field.pressure.begin(), field.pressure.end(), 0.0);
  EXPECT_NEAR(table().on(field), linear(0.15, 0.0, 0.3), 1e-9);
}

TEST(FocusWidths, GiveThePlansOfTheirSigma) {
  const TargetField field = fields::make(fields::Pattern::FourPlumes, 20, 40);
  for (const Preset preset : {Preset::Best, Preset::Fast, Preset::Felt, Preset::PaperValid}) {
    PlanSettings with, without;
    with.preset = without.preset = preset;
    with.widths = constant(5e-3);
    const bool by_place = preset != Preset::PaperValid;
    if (by_place) without.sigma = 5e-3;
    EXPECT_DOUBLE_EQ(with.sigma_on(field), without.sigma);
    Planner a(with, field.size()), b(without, field.size());
    Plan of_widths, of_sigma;
    PlanStats stats;
    for (int update = 0; update < 2; ++update) {
      ASSERT_EQ(a.plan(field, of_widths, stats), PlanStatus::Planned);
      ASSERT_EQ(b.plan(field, of_sigma, stats), PlanStatus::Planned);
      ASSERT_EQ(of_widths.paths.size(), of_sigma.paths.size());
      for (std::size_t k = 0; k < of_sigma.paths.size(); ++k) {
        EXPECT_EQ(of_widths.paths[k].points, of_sigma.paths[k].points) << name_of(preset);
        EXPECT_EQ(of_widths.paths[k].pressure, of_sigma.paths[k].pressure) << name_of(preset);
      }
    }
  }
}

TEST(FocusWidths, DoNotAllocateAndKeepPlansValidWhileTheHandRises) {
  PlanSettings settings;
  settings.preset = Preset::Fast;
  settings.widths = table();
  TargetField field = fields::make(fields::Pattern::OnePlume, 20, 40);
  Planner planner(settings, field.size());
  Plan plan;
  PlanStats stats;
  const test::HeapGuard guard;
  for (int update = 0; update < 20; ++update) {
    field.X_DP.translation().z() = 0.1 + 0.01 * update;
    ASSERT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
    EXPECT_EQ(stats.crossings, 0);
  }
  EXPECT_EQ(guard.allocations(), 0U);
}

TEST(FocusWidths, RejectInvalidTables) {
  validate(FocusWidths());
  FocusWidths widths = table();
  widths.sigma.pop_back();
  EXPECT_THROW(validate(widths), std::invalid_argument);
  widths = table();
  widths.height[1] = widths.height[0];
  EXPECT_THROW(validate(widths), std::invalid_argument);
  widths = table();
  widths.offset.clear();
  EXPECT_THROW(validate(widths), std::invalid_argument);
  widths = table();
  widths.sigma[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(widths), std::invalid_argument);
  PlanSettings settings;
  settings.widths = widths;
  EXPECT_THROW(Planner(settings, 100), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
