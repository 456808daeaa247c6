/// γ as a function of a path's period, (P9b).
#include "prostm/plan/gain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/fields/skin_shapes.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/score/disturbance.hpp"
#include "prostm/score/score.hpp"
#include "prostm/textbook/textbook.hpp"

namespace prostm {
namespace {

using fields::Pattern;

constexpr double kExponent = 0.5;

PlanSettings settings_with(const std::string& preset, double exponent) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(preset, "preset");
  settings.gain_exponent = exponent;
  settings.full_scale_pressure = 1e5;  // so high that it has no effect
  return settings;
}

void expect_near(const Metrics& a, const Metrics& b) {
  constexpr double kTolerance = 1e-9;
  EXPECT_NEAR(a.rmse, b.rmse, kTolerance);
  EXPECT_NEAR(a.correlation, b.correlation, kTolerance);
  EXPECT_NEAR(a.coverage, b.coverage, kTolerance);
  EXPECT_NEAR(a.skill_0, b.skill_0, kTolerance);
  EXPECT_NEAR(a.skill_8, b.skill_8, kTolerance);
  EXPECT_NEAR(a.overlap, b.overlap, kTolerance);
  EXPECT_NEAR(a.spill, b.spill, kTolerance);
}

/// Compares each path's pressures with those for exponent 0.
void expect_scaled(const Plan& plain, const Plan& scaled, double exponent) {
  ASSERT_EQ(plain.paths.size(), scaled.paths.size());
  for (std::size_t k = 0; k < plain.paths.size(); ++k) {
    const FocalPath &a = plain.paths[k], &b = scaled.paths[k];
    const double expected = std::pow(a.period * 50.0, exponent);
    ASSERT_EQ(a.period, b.period);
    for (std::size_t i = 0; i < a.points.size(); ++i) {
      ASSERT_EQ(a.points[i], b.points[i]);
      ASSERT_NEAR(b.pressure[i], expected * a.pressure[i], 1e-12 * (1.0 + a.pressure[i]));
    }
  }
}

TEST(GainLaw, IsTheStatedPowerLaw) {
  EXPECT_EQ(GainLaw{}.of(0.0), 1.4);
  EXPECT_EQ(GainLaw{}.of(0.0123), 1.4);
  EXPECT_DOUBLE_EQ((GainLaw{1.4, 1.0, 50.0}.of(0.01)), 0.7);
  EXPECT_DOUBLE_EQ((GainLaw{2.0, -0.5, 25.0}.of(0.01)), 4.0);
  // the longest path has the γ of the settings, for any exponent
  for (const double exponent : {-2.0, -0.3, 0.7, 2.0}) {
    EXPECT_DOUBLE_EQ((GainLaw{1.4, exponent, 50.0}.of(0.02)), 1.4);
  }
  // periods of 0 and of 10⁶ s
  EXPECT_DOUBLE_EQ((GainLaw{1.0, 1.0, 50.0}.of(0.0)), 1.0 / 16.0);
  EXPECT_DOUBLE_EQ((GainLaw{1.0, 1.0, 50.0}.of(1e6)), 16.0);
  EXPECT_DOUBLE_EQ((GainLaw{1.0, -2.0, 50.0}.of(0.0)), 256.0);
}

TEST(GainLaw, FromTheSkinFollowsItsTable) {
  const GainLaw law{1.4, 0.0, 50.0, true};
  EXPECT_DOUBLE_EQ(law.of(0.02), 1.4);
  EXPECT_DOUBLE_EQ(law.of(0.01), 1.4 * 0.825);
  EXPECT_DOUBLE_EQ(law.of(0.01125), 1.4 * 0.847);  // half-way
  EXPECT_DOUBLE_EQ(law.of(0.0), 1.4 * 0.713);
  EXPECT_DOUBLE_EQ(law.of(1.0), 1.4);
  // the longest path has the γ of the settings at any draw rate
  EXPECT_DOUBLE_EQ((GainLaw{2.0, 0.0, 100.0, true}.of(0.01)), 2.0);
  EXPECT_GT((GainLaw{2.0, 0.0, 100.0, true}.of(0.0125)), 2.0);
}

TEST(GainLaw, FromTheSkinChangesPressuresButNotPaths) {
  const TargetField field = fields::make(Pattern::Fingertips, 3);
  PlanSettings settings = settings_with("best", 0.0);
  const Plan plain = test::plan_of(settings, field);
  settings.gain_from_skin = true;
  const Plan scaled = test::plan_of(settings, field);
  ASSERT_EQ(plain.paths.size(), scaled.paths.size());
  bool weaker = false;
  for (std::size_t k = 0; k < plain.paths.size(); ++k) {
    const FocalPath &a = plain.paths[k], &b = scaled.paths[k];
    ASSERT_EQ(a.points, b.points);
    const double share = skin_gain(a.period);
    weaker = weaker || share < 0.9;
    for (std::size_t i = 0; i < a.pressure.size(); ++i) {
      EXPECT_NEAR(b.pressure[i], share * a.pressure[i], 1e-12 * (1.0 + a.pressure[i]));
    }
  }
  EXPECT_TRUE(weaker);
  settings.gain_exponent = 0.5;
  EXPECT_THROW(Planner(settings, 100), std::invalid_argument);
}

TEST(GainLaw, ScalesTheRenderedPressuresOfEveryPresetButNoScore) {
  for (const char* preset : {"paper", "paper-valid", "best", "fast"}) {
    for (const Pattern pattern : {Pattern::FourPlumes, Pattern::Fingertips, Pattern::Letter}) {
      SCOPED_TRACE(std::string(preset) + " on " + fields::to_string(pattern));
      const TargetField field = fields::make(pattern, 3);
      const PlanSettings plain = settings_with(preset, 0.0);
      const PlanSettings scaled = settings_with(preset, kExponent);
      const Plan a = test::plan_of(plain, field), b = test::plan_of(scaled, field);
      ASSERT_NO_FATAL_FAILURE(expect_scaled(a, b, kExponent));
      const Metrics of_a = score_plan(field, a, 0, plain.sigma, plain.gain_law());
      expect_near(of_a, score_plan(field, b, 0, scaled.sigma, scaled.gain_law()));
      const Disturbance moved{"moved", scaled.sigma, 3e-3};
      expect_near(score_disturbed(field, a, 0, moved, plain.gain_law()),
                  score_disturbed(field, b, 0, moved, scaled.gain_law()));
    }
  }
}

TEST(GainLaw, ShortPathsAreRenderedWeakerAndTheWrongLawShows) {
  const TargetField field = fields::make(Pattern::Fingertips, 3);
  const PlanSettings settings = settings_with("best", 1.0);
  const Plan plan = test::plan_of(settings, field);
  double shortest = 1.0;
  for (const FocalPath& path : plan.paths) shortest = std::min(shortest, path.period * 50.0);
  ASSERT_LT(shortest, 0.7);
  const double own = score_plan(field, plan, 0, settings.sigma, settings.gain_law()).rmse;
  EXPECT_GT(score_plan(field, plan, 0, settings.sigma, {1.4}).rmse, 1.1 * own);
}

TEST(GainLaw, UsesThePeriodOnTheSkin) {
  const TargetField field =
      fields::with_skin(fields::make(Pattern::Ridge, 2), fields::SkinShape::Fist, false);
  const Plan plain = test::plan_of(settings_with("best", 0.0), field);
  const Plan scaled = test::plan_of(settings_with("best", -1.0), field);
  bool longer = false;
  for (const FocalPath& path : plain.paths) {
    longer = longer || path.period > 1.02 * path.length / path.speed;
  }
  ASSERT_TRUE(longer);
  ASSERT_NO_FATAL_FAILURE(expect_scaled(plain, scaled, -1.0));
}

TEST(GainLaw, EachPathIsDividedByItsOwnGain) {
  // two distant points at rest with different periods
  Plan plan;
  for (const double x : {-0.05, 0.05}) {
    FocalPath path;
    path.points.push_back(Vec2(x, 0.0));
    path.pressure.push_back(1.0);
    path.period = x < 0.0 ? 0.02 : 0.005;
    plan.paths.push_back(path);
  }
  TargetField raster;
  raster.resize(1, 2);
  raster.cell = 0.1;
  raster.origin = Vec2(-0.05, 0.0);
  std::vector<double> field(2);
  quasi_static_field(plan, 0, raster, 8.6e-3, {2.0, 0.5, 50.0}, field);
  EXPECT_DOUBLE_EQ(field[0], 0.5);
  EXPECT_DOUBLE_EQ(field[1], 1.0);
  // the other patch's paths come first and do not count
  plan.paths[0].patch = 1;
  quasi_static_field(plan, 0, raster, 8.6e-3, {2.0, 0.5, 50.0}, field);
  EXPECT_DOUBLE_EQ(field[1], 1.0);
}

TEST(GainLaw, ControlsAndTheTextbookScoreAsWithAConstantGain) {
  const TargetField field = fields::make(Pattern::FourPlumes, 5);
  const TargetField elsewhere = fields::make(Pattern::Fingertips, 5);
  const PlanSettings plain = settings_with("best", 0.0), scaled = settings_with("best", kExponent);
  const Plan a = test::plan_of(plain, elsewhere), b = test::plan_of(scaled, elsewhere);
  const auto of_a = controls(field, plain.sigma, plain.gain_law(), 0.14, &a, 1);
  const auto of_b = controls(field, scaled.sigma, scaled.gain_law(), 0.14, &b, 1);
  ASSERT_EQ(of_a.size(), 4U);
  ASSERT_EQ(of_b.size(), 4U);
  for (std::size_t c = 0; c < of_a.size(); ++c) {
    SCOPED_TRACE(of_a[c].name);
    expect_near(of_a[c].metrics, of_b[c].metrics);
  }

  Plan c, d;
  PlanStats stats;
  ASSERT_EQ(textbook::plan(field, plain, c, stats), PlanStatus::Planned);
  ASSERT_EQ(textbook::plan(field, scaled, d, stats), PlanStatus::Planned);
  ASSERT_NO_FATAL_FAILURE(expect_scaled(c, d, kExponent));
}

TEST(GainLaw, BoundsAreReportedInOneSentence) {
  for (const double exponent : {-2.1, 2.1}) {
    try {
      Planner planner(settings_with("best", exponent), 100);
      FAIL() << exponent;
    } catch (const std::invalid_argument& e) {
      EXPECT_EQ(std::string(e.what()),
                (exponent < 0.0 ? "gain_exponent = -2.1" : "gain_exponent = 2.1") +
                    std::string(" must be between -2 and 2"));
    }
  }
}

}  // namespace
}  // namespace prostm
