#include "prostm/pipeline/snapshot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "prostm/emit/played.hpp"

namespace prostm {
namespace {

/// Returns a plan for a contact so small that pressures along its path change rapidly.
PlanSnapshot small_contact() {
  PlanSnapshot s;
  s.target.patches.emplace_back();
  TargetField& field = s.target.patches[0];
  field.resize(40, 40);
  field.cell = 4e-3;
  field.skin.assign(field.size(), 1);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double d2 = (field.position(i) - Vec2(0.07, 0.08)).squaredNorm();
    field.pressure[i] = 0.3 * std::exp(-d2 / (2.0 * 6e-3 * 6e-3));
  }
  auto settings = std::make_shared<PipelineSettings>();
  settings->plan.preset = Preset::Fast;
  Planner planner(settings->plan, field.size());
  PlanStats stats;
  s.planned = planner.plan(s.target, s.plan, stats) == PlanStatus::Planned;
  s.settings = settings;
  s.emission_rate = 40e3;
  return s;
}

TEST(RenderedPlan, IsThePlayedFieldAtTheSessionsFullScale) {
  PlanSnapshot s = small_contact();
  ASSERT_TRUE(s.planned);
  const TargetField& field = s.target.patches[0];
  RenderedPlan out;
  double rmse = 0.0;
  for (const double share : {1.4, 0.5}) {
    s.full_scale_pressure = share * max_pressure(field);
    render(s, out);
    EmitSettings emit = s.settings->emit;
    emit.full_scale_pressure = s.full_scale_pressure;
    const SegmentPressures played = played_pressures(s.plan, s.target, emit, 40e3);
    const Metrics expected =
        score_plan(field, s.plan, 0, s.settings->plan.sigma, s.settings->plan.gain_law(), &played);
    EXPECT_EQ(out.metrics.rmse, expected.rmse);
    EXPECT_EQ(out.metrics.skill_8, expected.skill_8);
    // pressures that the device cannot play are missing here too
    EXPECT_GT(out.metrics.rmse, 1.2 * rmse);
    rmse = out.metrics.rmse;
  }
}

TEST(RenderedPlan, UsesTheArraysWidthOrTheSettings) {
  PlanSnapshot s = small_contact();
  s.full_scale_pressure = 1.4 * max_pressure(s.target.patches[0]);
  RenderedPlan wide, narrow;
  render(s, wide);
  EXPECT_EQ(wide.metrics.rmse, wide.metrics_at_setting.rmse);
  PipelineSettings settings = *s.settings;
  settings.array_width = true;
  settings.plan.widths = plan_settings(settings, settings.emission_rate()).widths;
  s.settings = std::make_shared<PipelineSettings>(settings);
  render(s, narrow);
  EXPECT_EQ(narrow.sigma, settings.plan.sigma_on(s.target.patches[0]));
  EXPECT_LT(narrow.sigma, 0.9 * wide.sigma);
  EXPECT_NE(narrow.metrics.rmse, wide.metrics.rmse);
  EXPECT_EQ(narrow.metrics_at_setting.rmse, wide.metrics.rmse);
}

}  // namespace
}  // namespace prostm
