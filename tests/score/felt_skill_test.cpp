#include "prostm/score/felt_skill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/felt.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3;  // [Hz]

/// A target in a frame, with its pressure times `factor`, and its plan.
struct Planned {
  explicit Planned(double factor = 1.0) {
    frame.patches.push_back(fields::make(fields::Pattern::OnePlume, 50, 32));
    TargetField& target = frame.patches[0];
    for (double& p : target.pressure) p *= factor;
    PlanStats stats;
    PlanSettings settings;
    settings.preset = Preset::Fast;
    Planner(settings, target.size()).plan(target, plan, stats);
  }
  TargetFrame frame;
  Plan plan;
};

double felt(const Planned& planned, const Plan& plan, const EmitSettings& settings = {}) {
  WorkerPool pool(1);
  return felt_skill(plan, planned.frame, 0, settings, kRate, usx_array(), pool);
}

TEST(FeltSkill, MatchesThePerceptOfTheLoop) {
  const Planned planned;
  const TargetField& target = planned.frame.patches[0];
  const LoopSamples loop = plan_loop(planned.plan, planned.frame, {}, kRate);
  const Medium air;
  LoopDriveResult drives;
  loop_drives(
      usx_array(), air, loop, {}, [](int, int) { return true; }, drives);
  WorkerPool pool(2);
  const FeltField percept =
      FeelingSkin(target).feel(PackedArray(usx_array(), air), air, target, loop, drives, pool);
  const double skill = score_physical(target, percept.percept, 0.0).skill_8;
  EXPECT_EQ(felt(planned, planned.plan), skill);
  EXPECT_GT(skill, 0.3);
  EXPECT_LE(skill, 1.0);
}

TEST(FeltSkill, DoesNotDependOnTheUnitOfTheTarget) {
  const Planned one, thousand(1000.0);
  EXPECT_NEAR(felt(one, one.plan), felt(thousand, thousand.plan), 0.02);
}

TEST(FeltSkill, IsUnknownWithoutPressureOrWithoutAPlan) {
  Planned planned;
  EXPECT_TRUE(std::isnan(felt(planned, {})));
  std::fill(planned.frame.patches[0].pressure.begin(), planned.frame.patches[0].pressure.end(),
            0.0);
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan)));
}

TEST(FeltSkill, IsUnknownIfStopped) {
  const Planned planned;
  WorkerPool pool(1);
  const auto skill = [&](bool go_on) {
    return felt_skill(planned.plan, planned.frame, 0, {}, kRate, usx_array(), pool,
                      [&] { return go_on; });
  };
  EXPECT_FALSE(std::isnan(skill(true)));
  EXPECT_TRUE(std::isnan(skill(false)));
}

TEST(FeltSkill, IsUnknownForAPlanThatNoArrayCanPlay) {
  Planned planned;
  EmitSettings unheard;
  unheard.full_scale_pressure = 1e9;
  unheard.silent_below = 0.5;
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan, unheard)));
  for (FocalPath& path : planned.plan.paths)
    std::fill(path.pressure.begin(), path.pressure.end(), 0.0);
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan)));
}

TEST(FeltSkill, IsUnknownIfALapTakesTooLong) {
  for (const double speed : {0.5, 0.05}) {  // laps below and above the limit of a loop
    Planned planned;
    for (FocalPath& path : planned.plan.paths) path.speed = speed;
    EXPECT_TRUE(std::isnan(felt(planned, planned.plan))) << speed;
  }
}

TEST(PlanLoop, RejectsAPlanWithoutPressure) {
  Planned planned;
  for (FocalPath& path : planned.plan.paths)
    std::fill(path.pressure.begin(), path.pressure.end(), 0.0);
  EXPECT_THROW(plan_loop(planned.plan, planned.frame, {}, kRate), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
