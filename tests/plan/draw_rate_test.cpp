/// The draw rate, which together with the speed bounds the length of a path.
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "random_fields.hpp"

namespace prostm {
namespace {

using fields::Pattern;

constexpr std::size_t kCells = static_cast<std::size_t>(fields::kCells) * fields::kCells;

PlanSettings settings_at(const std::string& preset, double speed, double draw_rate) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(preset, "preset");
  settings.speed = speed;
  settings.draw_rate = draw_rate;
  return settings;
}

TEST(DrawRate, TheDefaultsGiveThePapersLengthExactly) {
  EXPECT_EQ(PlanSettings{}.max_length(), 0.140);
  EXPECT_DOUBLE_EQ(settings_at("best", 3.5, 25.0).max_length(), 0.140);
  EXPECT_DOUBLE_EQ(settings_at("best", 5.0, 25.0).max_length(), 0.2);
}

TEST(DrawRate, NoPathIsDrawnLessOften) {
  for (const char* preset : {"paper-valid", "best", "fast"}) {
    for (const double rate : {20.0, 35.0, 50.0, 90.0, 150.0, 400.0, 700.0}) {
      const PlanSettings settings = settings_at(preset, 7.0, rate);
      for (const Pattern pattern : {Pattern::OnePlume, Pattern::Noise, Pattern::Fingertips}) {
        SCOPED_TRACE(std::string(preset) + " at " + std::to_string(rate) + " Hz");
        const Plan plan = test::plan_of(settings, fields::make(pattern, 4));
        ASSERT_FALSE(plan.paths.empty());
        const auto samples = static_cast<int>(plan.paths.front().points.size());
        ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, samples, 7.0 / rate));
        for (const FocalPath& path : plan.paths) {
          ASSERT_EQ(path.speed, 7.0);
          ASSERT_LE(path.period * rate, 1.0 + 1e-6);
        }
      }
    }
  }
}

/// Starts each path at the first point of the path in `like`; the starts depend on the periods.
Plan begun_like(Plan plan, const Plan& like) {
  for (std::size_t k = 0; k < plan.paths.size() && k < like.paths.size(); ++k) {
    FocalPath& path = plan.paths[k];
    const auto first =
        std::find(path.points.begin(), path.points.end(), like.paths[k].points.front());
    const auto place = first - path.points.begin();
    if (first == path.points.end()) continue;
    std::rotate(path.points.begin(), first, path.points.end());
    std::rotate(path.pressure.begin(), path.pressure.begin() + place, path.pressure.end());
    path.length = closed_length(path);
  }
  return plan;
}

TEST(DrawRate, PathsDependOnTheLengthsAlone) {
  for (const char* preset : {"paper", "paper-valid", "best", "fast"}) {
    const TargetField field = fields::make(Pattern::FourPlumes, 2);
    // a path's length and the length of an intensity's rise are the same in both plans
    PlanSettings settings = settings_at(preset, 1.75, 12.5);
    settings.rise_time = 4e-3;
    const Plan slow = test::plan_of(settings, field);
    settings = settings_at(preset, 7.0, 50.0);
    settings.rise_time = 1e-3;
    const Plan fast = begun_like(test::plan_of(settings, field), slow);
    ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(slow, fast, 1.0));
    for (std::size_t k = 0; k < slow.paths.size(); ++k) {
      EXPECT_DOUBLE_EQ(slow.paths[k].period, 4.0 * fast.paths[k].period);
    }
  }
}

TEST(DrawRate, ThePapersPathsHaveItsStatedLength) {
  for (const double rate : {40.0, 50.0, 80.0}) {
    const TargetField field = fields::make(Pattern::OnePlume, 0);
    for (const FocalPath& path : test::plan_of(settings_at("paper", 7.0, rate), field).paths) {
      EXPECT_NEAR(path.length, 7.0 / rate, 0.03 * path.length) << rate;
    }
  }
}

TEST(DrawRate, MinimumLengthYieldsToDrawRate) {
  // a contact that would get a loop of 35 mm, at rates that do not allow it
  TargetField field;
  field.resize(30, 30);
  field.cell = 4e-3;
  field.skin.assign(field.size(), 1);
  test::touch(field, 15, 15, 1.0);
  for (const double rate : {250.0, 400.0}) {
    const Plan plan = test::plan_of(settings_at("best", 7.0, rate), field);
    ASSERT_EQ(plan.paths.size(), 1U);
    EXPECT_LE(plan.paths[0].length, 7.0 / rate + 1e-9);
    EXPECT_GT(plan.paths[0].length, 0.9 * 7.0 / rate);
  }
}

TEST(DrawRate, BoundsAreReportedInOneSentence) {
  const auto message = [](double speed, double rate) -> std::string {
    try {
      Planner planner(settings_at("best", speed, rate), kCells);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(7.0, 7.0), "");
  EXPECT_EQ(message(7.0, 700.0), "");
  EXPECT_EQ(message(0.1, 0.1), "");
  EXPECT_EQ(message(8.0, 790.0), "");
  EXPECT_EQ(message(7.0, 0.0), "draw_rate = 0 Hz must be between 0.1 and 10000 Hz");
  EXPECT_EQ(message(7.0, 5.0), "speed / draw_rate = 1.4 m must be between 0.01 and 1 m");
  EXPECT_EQ(message(7.0, 1000.0), "speed / draw_rate = 0.007 m must be between 0.01 and 1 m");
  EXPECT_EQ(message(8.1, 50.0), "speed = 8.1 m/s must be between 0.1 and 8 m/s");
}

}  // namespace
}  // namespace prostm
