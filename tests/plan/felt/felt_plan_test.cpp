#include "prostm/plan/felt_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "plan/plan_checks.hpp"
#include "plan/random_fields.hpp"
#include "prostm/fields/fields.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

constexpr double kSigma = 4.3e-3;

PlanSettings felt(bool points) {
  PlanSettings settings;
  settings.sigma = kSigma;
  settings.felt_weight = 1.0;
  settings.felt_points = points;
  return settings;
}

TEST(FeltPlan, HasTheGradientOfItsLack) {
  for (const fields::Pattern pattern : {fields::Pattern::FourPlumes}) {
    const TargetField field = fields::make(pattern, 10);
    Plan plan = test::plan_of(felt(false), field);
    const std::vector<SkinSettings> skins = felt_skins();
    const FeltPlan at = felt_plan(plan, field, kSigma, skins);
    const double largest = max_pressure(field);
    const auto difference = [&](double& value, double step) {
      const double here = value;
      value = here + step;
      const double after = felt_plan(plan, field, kSigma, skins).lack;
      value = here - step;
      const double before = felt_plan(plan, field, kSigma, skins).lack;
      value = here;
      return (after - before) / (2.0 * step);
    };
    for (const std::size_t k : {0, 1}) {
      for (const std::size_t i : {0, 41}) {
        // in the planner's units: fractions of the maximum, and mm
        const double by_pressure = difference(plan.paths[k].pressure[i], 1e-5 * largest);
        EXPECT_NEAR(at.by_pressure[k][i] * largest, by_pressure * largest, 1e-6);
        for (const int axis : {0, 1}) {
          const double by_point = difference(plan.paths[k].points[i][axis], 1e-7);
          EXPECT_NEAR(1e-3 * at.by_point[k][i][axis], 1e-3 * by_point, 1e-6);
        }
      }
    }
  }
}

TEST(FeltPlan, PressuresReduceTheLackAndPointsReduceItMore) {
  double plain = 0.0, by_pressures = 0.0, by_points = 0.0;
  for (const fields::Pattern pattern : {fields::Pattern::FourPlumes, fields::Pattern::Ring,
                                        fields::Pattern::Letter, fields::Pattern::Palm}) {
    const TargetField field = fields::make(pattern, 40);
    PlanSettings settings = felt(false);
    settings.felt_weight = 0.0;
    Plan plan = test::plan_of(settings, field);
    plan.loop = 1.0 / settings.draw_rate;
    for (FocalPath& path : plan.paths) path.period = plan.loop;
    const std::vector<SkinSettings> skins = felt_skins();
    const auto lack = [&](const Plan& p) { return felt_plan(p, field, kSigma, skins).lack; };
    plain += lack(plan);
    by_pressures += lack(test::plan_of(felt(false), field));
    by_points += lack(test::plan_of(felt(true), field));
  }
  EXPECT_LT(by_pressures, 0.55 * plain);
  EXPECT_LT(by_points, 0.9 * by_pressures);
}

TEST(FeltPlan, RejectsInvalidSettingsWithASentence) {
  const TargetField field = fields::make(fields::Pattern::Ring, 10);
  const Plan plan = test::plan_of(felt(false), field);
  const auto message = [](const Plan& p, const TargetField& f, double sigma) -> std::string {
    try {
      felt_plan(p, f, sigma, felt_skins());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  Plan on_its_own = plan, silent = plan;
  on_its_own.loop = 0.0;
  for (FocalPath& path : silent.paths) std::fill(path.pressure.begin(), path.pressure.end(), 0.0);
  TargetField empty = field;
  std::fill(empty.pressure.begin(), empty.pressure.end(), 0.0);
  EXPECT_EQ(message(plan, field, kSigma), "");
  EXPECT_THAT(message(on_its_own, field, kSigma), testing::HasSubstr("preset felt"));
  EXPECT_THAT(message(silent, field, kSigma), testing::HasSubstr("no pressure"));
  EXPECT_THAT(message(Plan(), field, kSigma), testing::HasSubstr("no path"));
  EXPECT_THAT(message(plan, empty, kSigma), testing::HasSubstr("no pressure"));
  EXPECT_THAT(message(plan, field, 0.2), testing::HasSubstr("sigma"));
}

/// Checks that a plan in step is playable.
void expect_in_step(const Plan& plan, const PlanSettings& settings, const std::string& where) {
  SCOPED_TRACE(where);
  ASSERT_NO_FATAL_FAILURE(
      test::expect_valid_plan(plan, 2 * settings.fit_samples, settings.max_length()));
  EXPECT_LE(plan.loop, 1.0 / settings.draw_rate);
  EXPECT_GE(plan.loop, 0.5 / settings.draw_rate);
  for (const FocalPath& path : plan.paths) {
    const double laps = plan.loop / path.period;
    EXPECT_NEAR(laps, std::round(laps), 1e-9);
    EXPECT_LE(path.speed, settings.speed * (1.0 + 1e-9));
  }
}

TEST(FeltPlan, IsValidForAnyTarget) {
  for (const bool points : {false, true}) {
    Random random(11);
    const PlanSettings settings = felt(points);
    Planner planner(settings, 64 * 64);
    const std::uint64_t draws = points ? 30 : 400;
    for (std::uint64_t draw = 0; draw < test::reduced(draws); ++draw) {
      const test::RandomField any = test::random_field(random, 40);
      Plan plan;
      PlanStats stats;
      if (draw % 3 == 0) planner.reset();
      const PlanStatus status = planner.plan(any.field, plan, stats);
      if (status != PlanStatus::Planned) continue;
      ASSERT_NO_FATAL_FAILURE(expect_in_step(plan, settings, std::to_string(draw)));
      double largest = 0.0;
      for (const FocalPath& path : plan.paths)
        largest = std::max(largest, *std::max_element(path.pressure.begin(), path.pressure.end()));
      ASSERT_LE(largest, settings.gain * max_pressure(any.field) * (1.0 + 1e-6));
    }
  }
}

TEST(FeltPlan, DependsOnlyOnTheSeedAndNotOnTheUnit) {
  const TargetField field = fields::make(fields::Pattern::Letter, 20);
  const Plan plan = test::plan_of(felt(true), field), again = test::plan_of(felt(true), field);
  TargetField scaled = field;
  for (double& p : scaled.pressure) p *= 1024.0;
  const Plan in_another_unit = test::plan_of(felt(true), scaled);
  ASSERT_EQ(plan.paths.size(), again.paths.size());
  for (std::size_t k = 0; k < plan.paths.size(); ++k) {
    EXPECT_EQ(plan.paths[k].points, again.paths[k].points);
    EXPECT_EQ(plan.paths[k].pressure, again.paths[k].pressure);
    EXPECT_EQ(plan.paths[k].points, in_another_unit.paths[k].points);
    for (std::size_t i = 0; i < plan.paths[k].pressure.size(); ++i)
      EXPECT_EQ(1024.0 * plan.paths[k].pressure[i], in_another_unit.paths[k].pressure[i]);
  }
}

TEST(FeltPlan, DoesNotAllocate) {
  for (const bool points : {false, true}) {
    Planner planner(felt(points), fields::kCells * fields::kCells);
    const TargetField one = fields::make(fields::Pattern::OnePlume, 1);
    const TargetField noise = fields::make(fields::Pattern::Noise, 1);
    Plan plan;
    PlanStats stats;
    const test::HeapGuard guard;
    planner.plan(one, plan, stats);
    planner.plan(noise, plan, stats);
    EXPECT_EQ(guard.allocations(), 0U);
  }
}

TEST(PlanSettings, FeltWeightNeedsAFittedPreset) {
  PlanSettings settings = felt(false);
  settings.preset = Preset::PaperValid;
  EXPECT_THROW(validate(settings), std::invalid_argument);
  settings.felt_weight = 0.0;
  EXPECT_NO_THROW(validate(settings));
}

}  // namespace
}  // namespace prostm
