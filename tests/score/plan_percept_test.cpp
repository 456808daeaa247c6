#include "prostm/score/plan_percept.hpp"

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

PlanPercept percept(const Planned& planned, const Plan& plan, const EmitSettings& settings = {},
                    const TransducerArray& array = usx_array()) {
  WorkerPool pool(1);
  return plan_percept(plan, planned.frame, 0, settings, kRate, array, pool);
}
double felt(const Planned& planned, const Plan& plan, const EmitSettings& settings = {}) {
  return percept(planned, plan, settings).skill;
}

TEST(PlanPercept, MatchesThePerceptOfTheLoop) {
  const Planned planned;
  const TargetField& target = planned.frame.patches[0];
  const LoopSamples loop = plan_loop(planned.plan, planned.frame, {}, kRate);
  const Medium air;
  LoopDriveResult drives;
  loop_drives(
      usx_array(), air, loop, {}, [](int, int) { return true; }, drives);
  WorkerPool pool(2);
  const FeltField felt =
      FeelingSkin(target).feel(PackedArray(usx_array(), air), air, target, loop, drives, pool);
  const double skill = score_physical(target, felt.percept, 0.0).skill_8;
  const PlanPercept of_plan = percept(planned, planned.plan);
  EXPECT_EQ(of_plan.skill, skill);
  EXPECT_EQ(of_plan.sensation_level, loop_sensation_level(felt, loop, usx_array()));
  EXPECT_GT(skill, 0.3);
  EXPECT_LE(skill, 1.0);
}

TEST(PlanPercept, IsWeakerWhereIntensitiesAreLow) {
  const Planned planned;
  const double strong = percept(planned, planned.plan).sensation_level;
  EmitSettings quiet;
  quiet.silent_below = 0.0;
  for (const double share : {0.25, 0.0625}) {  // of the pressure at intensity 1
    quiet.full_scale_pressure = largest_pressure(planned.plan) / share;
    EXPECT_NEAR(percept(planned, planned.plan, quiet).sensation_level,
                strong + 20.0 * std::log10(share), 0.5);
  }
  TransducerArray nominal = usx_array();
  nominal.measured_amplitude = 0.0;
  EXPECT_NEAR(percept(planned, planned.plan, {}, nominal).sensation_level, strong + 19.66, 0.01);
}

TEST(PlanPercept, DoesNotDependOnTheUnitOfTheTarget) {
  const Planned one, thousand(1000.0);
  EXPECT_NEAR(felt(one, one.plan), felt(thousand, thousand.plan), 0.02);
}

TEST(PlanPercept, IsUnknownWithoutPressureOrWithoutAPlan) {
  Planned planned;
  EXPECT_TRUE(std::isnan(felt(planned, {})));
  std::fill(planned.frame.patches[0].pressure.begin(), planned.frame.patches[0].pressure.end(),
            0.0);
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan)));
}

TEST(PlanPercept, IsUnknownIfStopped) {
  const Planned planned;
  WorkerPool pool(1);
  const auto skill = [&](bool go_on) {
    return plan_percept(planned.plan, planned.frame, 0, {}, kRate, usx_array(), pool,
                        [&] { return go_on; })
        .skill;
  };
  EXPECT_FALSE(std::isnan(skill(true)));
  EXPECT_TRUE(std::isnan(skill(false)));
}

TEST(PlanPercept, IsUnknownForAPlanThatNoArrayCanPlay) {
  Planned planned;
  EmitSettings unheard;
  unheard.full_scale_pressure = 1e9;
  unheard.silent_below = 0.5;
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan, unheard)));
  for (FocalPath& path : planned.plan.paths)
    std::fill(path.pressure.begin(), path.pressure.end(), 0.0);
  EXPECT_TRUE(std::isnan(felt(planned, planned.plan)));
}

TEST(PlanPercept, IsUnknownIfALapTakesTooLong) {
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
