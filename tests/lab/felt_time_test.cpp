#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "acoustics/skin_loops.hpp"
#include "felt_time/felt_live.hpp"
#include "felt_time/time_skin.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::bench {
namespace {

const SkinPatch kPatch{32, 32, 5e-3};  // as the generated fields

/// The nominal skin; its time steps are computed once for all tests.
const TimeSkin& time_skin() {
  static const TimeSkin skin(SkinModel{SkinSettings{}}, kPatch);
  return skin;
}

/// Returns the percept by (S7), and that of time steps after half a second.
std::pair<std::vector<double>, std::vector<double>> percepts(const test::CirclingFocus& focus) {
  const int samples = static_cast<int>(std::round(focus.period / kFeltTick));
  const std::vector<double> loop = test::sampled(focus, kPatch, samples);
  SkinResponse response(SkinModel{SkinSettings{}}, kPatch);
  response.prepare(focus.period, samples);
  response.respond({focus.period, samples, loop});
  std::pair<std::vector<double>, std::vector<double>> out;
  out.first.resize(kPatch.size());
  percept_map(response, out.first);
  std::vector<float> pressure;
  const auto laps = static_cast<std::size_t>(std::ceil(1.3 / focus.period));
  for (std::size_t lap = 0; lap < laps; ++lap) {
    pressure.insert(pressure.end(), loop.begin(), loop.end());
  }
  const std::vector<float> felt = time_skin().respond(pressure);
  const auto window = static_cast<std::size_t>(std::round(kFeltWindow / kFeltTick));
  out.second = percept_over(felt, kPatch.size(), 2500, window);
  return out;
}

TEST(TimeSkin, ALoopSettlesToThePerceptOfItsHarmonics) {
  for (const double period : {20e-3, 10e-3}) {
    test::CirclingFocus focus;
    focus.period = period;
    focus.radius = 20e-3;
    const auto [expected, found] = percepts(focus);
    const double largest = *std::max_element(expected.begin(), expected.end());
    double difference = 0.0;
    for (std::size_t c = 0; c < expected.size(); ++c) {
      difference = std::max(difference, std::abs(expected[c] - found[c]));
    }
    RecordProperty("relative difference", std::to_string(difference / largest));
    EXPECT_LT(difference, 1e-3 * largest) << difference / largest;
  }
}

TEST(TimeSkin, AConstantPressureIsNotFelt) {
  std::vector<float> pressure(kPatch.size() * 6000, 0.0F);
  for (std::size_t tick = 2000; tick < 6000; ++tick) pressure[tick * kPatch.size() + 528] = 100.0F;
  const std::vector<float> felt = time_skin().respond(pressure);
  const auto at = [&](std::size_t first) { return percept_over(felt, kPatch.size(), first, 200); };
  const double onset = at(1950)[528];
  EXPECT_GT(onset, 0.0);
  EXPECT_LT(at(4800)[528], 0.03 * onset);
  EXPECT_LT(at(1000)[528], 0.03 * onset);
  EXPECT_THROW(time_skin().respond(std::vector<float>(7)), std::invalid_argument);
}

TEST(TimeSkin, BlocksJoinSeamlessly) {
  test::CirclingFocus focus;
  focus.period = 20e-3;
  const std::vector<double> loop = test::sampled(focus, kPatch, 100);
  std::vector<float> pressure;
  for (int lap = 0; lap < 60; ++lap) pressure.insert(pressure.end(), loop.begin(), loop.end());
  const std::vector<float> felt = time_skin().respond(pressure);
  const auto before = percept_over(felt, kPatch.size(), 1900, 100);
  for (const std::size_t first : {2050u, 2096u, 4150u, 4192u}) {
    const auto after = percept_over(felt, kPatch.size(), first, 100);
    EXPECT_NEAR(after[530] / before[530], 1.0, 2e-3) << first;
  }
}

TEST(TimeSkin, SettingsAreChecked) {
  const SkinModel skin{SkinSettings{}};
  EXPECT_THROW(TimeSkin(skin, {65, 20, 5e-3}), std::invalid_argument);
  EXPECT_THROW(TimeSkin(skin, {20, 20, 1e-3}), std::invalid_argument);
}

std::vector<LivePlan> plans_of(Method method, int frames, fields::Pattern pattern) {
  std::vector<LivePlan> out;
  PlanSettings settings;
  settings.preset = Preset::Fast;
  Planner paths(settings, kPatch.size());
  AmPlanner foci(AmSettings(), kPatch.size());
  for (int i = 0; i < frames; ++i) {
    LivePlan live;
    live.target = fields::make(pattern, 50, kPatch.rows);
    PlanStats stats;
    if (method == Method::ProStm) {
      paths.reset();
      paths.plan(live.target, live.plan, stats);
    } else {
      foci.plan(live.target, live.plan, stats);
    }
    out.push_back(live);
  }
  return out;
}

/// Gives the paths of a plan one loop of 20 ms.
void put_in_step(LivePlan& live) {
  live.plan.loop = 0.02;
  for (FocalPath& path : live.plan.paths) {
    const double length = skin_length(path, live.target);
    const double laps = std::max(1.0, std::round(live.plan.loop / (length / path.speed)));
    path.period = live.plan.loop / laps;
    path.speed = length / path.period;
  }
}

LiveFelt felt(Method method, const std::vector<LivePlan>& plans) {
  WorkerPool pool(2);
  LiveSettings settings;
  settings.settling = 0.2;
  LiveFelt out;
  EXPECT_TRUE(felt_live(
      method, plans, settings, usx_array(), time_skin(), pool,
      [](std::size_t, std::size_t) { return true; }, out));
  return out;
}

/// Checks that a plan sent repeatedly is felt like its loop, within an error of S_8.5.
void expect_as_its_loop(Method method, const std::vector<LivePlan>& plans, double error) {
  const LiveFelt live = felt(method, plans);
  TargetFrame frame;
  frame.patches.push_back(plans[0].target);
  WorkerPool pool(2);
  const double loop = plan_percept(plans[0].plan, frame, 0, {}, 40e3, usx_array(), pool).skill;
  EXPECT_NEAR(live.metrics.skill_8, loop, error);
  for (std::size_t c = 0; c < live.mean_target.size(); ++c) {
    ASSERT_NEAR(live.mean_target[c], plans[0].target.pressure[c], 1e-12);
  }
  EXPECT_EQ(live.window_skill_8.size(), 7u);  // for (480 − 200) ms
  EXPECT_EQ(live.window_percept.size(), 7u * live.percept.size());
  EXPECT_GT(live.intensity, 0.0);
  EXPECT_EQ(live.emit.refused_plans, 0);
}

TEST(FeltLive, FociAreFeltLikeTheirLoop) {
  expect_as_its_loop(Method::Am, plans_of(Method::Am, 12, fields::Pattern::FourPlumes), 0.002);
}

TEST(FeltLive, PathsInStepAreFeltLikeTheirLoop) {
  std::vector<LivePlan> plans = plans_of(Method::ProStm, 12, fields::Pattern::FourPlumes);
  for (LivePlan& live : plans) put_in_step(live);
  expect_as_its_loop(Method::ProStm, plans, 0.015);
}

// Paths have individual periods, which a loop makes equal, and drift out of step.
TEST(FeltLive, OtherPathsAreFeltNearlyLikeTheirLoop) {
  expect_as_its_loop(Method::ProStm, plans_of(Method::ProStm, 12, fields::Pattern::FourPlumes),
                     0.06);
}

TEST(FeltLive, WanderingPlansAreFeltLessWell) {
  std::vector<LivePlan> plans = plans_of(Method::ProStm, 10, fields::Pattern::Ring);
  const double steady = felt(Method::ProStm, plans).metrics.skill_8;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    for (FocalPath& path : plans[i].plan.paths) {
      for (Vec2& point : path.points) point.x() += i % 2 == 0 ? 0.012 : -0.012;
    }
  }
  EXPECT_LT(felt(Method::ProStm, plans).metrics.skill_8, steady - 0.02);
}

TEST(FeltLive, InputIsChecked) {
  WorkerPool pool(1);
  LiveFelt out;
  const auto play = [&](const std::vector<LivePlan>& plans, const LiveSettings& settings) {
    return felt_live(
        Method::ProStm, plans, settings, usx_array(), time_skin(), pool,
        [](std::size_t, std::size_t) { return false; }, out);
  };
  EXPECT_THROW(play({}, {}), std::invalid_argument);
  std::vector<LivePlan> plans = plans_of(Method::ProStm, 1, fields::Pattern::OnePlume);
  EXPECT_THROW(play(plans, {}), std::invalid_argument);  // too short
  LiveSettings settings;
  settings.settling = 0.0;
  EXPECT_FALSE(play(plans, settings));  // stopped
  settings.sample_rate = 41e3;
  EXPECT_THROW(play(plans, settings), std::invalid_argument);
  settings.sample_rate = 40e3;
  plans[0].target.cell = 4e-3;
  EXPECT_THROW(play(plans, settings), std::invalid_argument);
}

}  // namespace
}  // namespace prostm::bench
