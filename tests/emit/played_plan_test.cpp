#include "prostm/emit/played_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "emit/paths.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3;  // [Hz]
constexpr int kSamples = 40'000;

/// Returns the emitter's samples of a plan, sample-major.
std::vector<FocusSample> samples_of(const LiftedPlan& plan, double max_speed = kMaxFocusSpeed) {
  EmitSettings settings = test::settings_for(static_cast<int>(plan.paths.size()));
  settings.stall_time = 10.0;
  PathEmitter emitter(settings, kRate, max_speed);
  emitter.draft() = plan;
  emitter.submit();
  std::vector<FocusSample> out(plan.paths.size() * static_cast<std::size_t>(kSamples));
  emitter.fill(0, out);
  return out;
}

/// Returns the period of a focal point in samples: the mean over its laps, each measured between
/// the samples nearest to the path's first point.
double period_of(const LiftedPath& path, const std::vector<FocusSample>& samples, std::size_t f,
                 std::size_t foci) {
  constexpr double kNear = 0.15e-3;  // [m], above half of the largest step
  constexpr int kApart = 20;         // samples, less than any lap here
  const auto distance = [&](int k) {
    const FocusSample& at = samples[static_cast<std::size_t>(k) * foci + f];
    return (at.p_D.cast<double>() - path.p_D[0]).norm();
  };
  int first = -1, last = -1, laps = -1;
  for (int k = 3; k + 1 < kSamples; ++k) {
    const double d = distance(k);
    if (d > kNear || d > distance(k - 1) || d > distance(k + 1)) continue;
    if (last >= 0 && k - last < kApart) continue;
    if (first < 0) first = k;
    last = k;
    ++laps;
  }
  return laps > 0 ? static_cast<double>(last - first) / laps : 0.0;
}

/// Rings far from each other.
LiftedPlan rings(Random& random, int paths, double least, double most, double speed) {
  LiftedPlan plan;
  for (int k = 0; k < paths; ++k) {
    const Vec3 centre(0.12 * k, 0.0, 0.2);
    plan.paths.push_back(test::ring(centre, random.uniform(least, most), 60, 1.0, speed));
  }
  return plan;
}

void expect_played(const LiftedPlan& plan, const PlayedPlan& played, double max_speed) {
  const std::vector<FocusSample> samples = samples_of(plan, max_speed);
  for (std::size_t f = 0; f < plan.paths.size(); ++f) {
    const double period = period_of(plan.paths[f], samples, f, plan.paths.size());
    ASSERT_GT(period, 0.0) << "path " << f;
    EXPECT_NEAR(played.paths[f].period * kRate, period, 0.1) << "path " << f;
    EXPECT_NEAR(played.paths[f].speed, plan.paths[f].length * kRate / period, 0.01);
    EXPECT_LE(played.paths[f].speed, max_speed);
  }
}

TEST(PlayedPlan, PeriodsAndSpeedsMatchTheSamples) {
  Random random(31);
  for (int round = 0; round < 60; ++round) {
    const double speed = random.uniform(1.0, 20.0);
    const LiftedPlan plan = rings(random, 1 + round % 4, 0.02, 0.2, speed);
    SCOPED_TRACE(testing::Message() << speed << " m/s");
    const double limit = round % 5 == 0 ? 7.0 : kMaxFocusSpeed;
    const PlayedPlan played = played_plan(plan, kRate, limit);
    expect_played(plan, played, limit);
    const bool slowed = speed > limit;
    EXPECT_EQ(played.changed_paths(), slowed ? 1 + round % 4 : 0);
    EXPECT_EQ(played_warnings(played).size(), slowed ? plan.paths.size() : 0U);
  }
}

TEST(PlayedPlan, PeriodsInStepMatchTheSamples) {
  Random random(32);
  for (int round = 0; round < 40; ++round) {
    LiftedPlan plan = rings(random, 2 + round % 3, 0.02, 0.2, 1.0);
    plan.loop = random.uniform(8e-3, 40e-3);
    for (LiftedPath& path : plan.paths) path.speed = random.uniform(1.0, 20.0);
    SCOPED_TRACE(testing::Message() << "loop of " << plan.loop);
    expect_played(plan, played_plan(plan, kRate), kMaxFocusSpeed);
  }
}

TEST(PlayedPlan, ASlowedPathIsReportedWithTheLimit) {
  LiftedPlan plan;
  plan.paths.push_back(test::ring(Vec3(0.0, 0.0, 0.2), 0.1, 60, 1.0, 10.0));
  const PlayedPlan played = played_plan(plan, kRate);
  EXPECT_NEAR(played.paths[0].planned_period, 10e-3, 1e-9);
  EXPECT_NEAR(played.paths[0].period, 12.525e-3, 1e-9);
  ASSERT_EQ(played_warnings(played).size(), 1U);
  EXPECT_THAT(played_warnings(played)[0],
              testing::HasSubstr("path 1 is planned at 10 m/s, 10.00 ms a lap, and played at 7.984 "
                                 "m/s, 12.53 ms: focal points move at 8 m/s at most"));
  // the loop for computing fields differs from the plan by the same factor
  const LoopSamples loop = loop_samples(plan, test::settings_for(1), kRate);
  EXPECT_NEAR(loop.largest_stretch(), 0.26, 0.01);
}

TEST(PlayedPlan, APathAtTheLimitIsUnchanged) {
  LiftedPlan plan;
  plan.paths.push_back(test::ring(Vec3(0.0, 0.0, 0.2), 0.2, 60, 1.0, kMaxFocusSpeed));
  EXPECT_EQ(played_plan(plan, kRate).changed_paths(), 0);
}

TEST(PlayedPlan, TheEmitterCountsPathsThatItChanges) {
  test::Player player(test::settings_for(2));
  player.submit({test::ring(Vec3(0.0, 0.0, 0.2), 0.1, 60, 1.0, 10.0),
                 test::ring(Vec3(0.1, 0.0, 0.2), 0.1, 60, 1.0, 7.0)});
  player.play(2);
  EXPECT_EQ(player.emitter.stats().changed_paths, 1);
}

TEST(PlayedPlan, TheEmitterCountsSamplesBelowTheSilentLevel) {
  test::Player player(test::settings_for(1));
  player.submit({test::ring(Vec3(0.0, 0.0, 0.2), 0.1, 60, 0.005)});
  player.play(10);
  EXPECT_GT(player.emitter.stats().silenced, 300);
}

/// A dome of skin with two bumps of pressure.
TargetFrame dome(Random& random) {
  TargetFrame frame;
  TargetField& field = frame.patches.emplace_back();
  field.resize(40, 40);
  field.cell = 3e-3;
  field.origin = Vec2::Constant(-0.5 * field.cell * 39.0);
  field.skin.assign(field.size(), 1);
  field.X_DP.translation() = Vec3(0.0, 0.0, 0.2);
  const double height = random.uniform(0.0, 0.03);
  const Vec2 a(random.uniform(-0.03, 0.03), random.uniform(-0.03, 0.03));
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const Vec2 x = field.position(row, col);
      const std::size_t cell = field.index(row, col);
      field.height[cell] = height * std::exp(-x.squaredNorm() / 2e-3);
      field.pressure[cell] =
          std::exp(-(x - a).squaredNorm() / 4e-4) + 0.7 * std::exp(-(x + a).squaredNorm() / 4e-4);
    }
  }
  return frame;
}

TEST(PlayedPlan, PlansOfEveryPresetHaveThePlayedPeriods) {
  Random random(33);
  constexpr std::array kPresets = {Preset::Paper, Preset::PaperValid, Preset::Best, Preset::Fast,
                                   Preset::Felt};
  for (int round = 0; round < 50; ++round) {
    const TargetFrame frame = dome(random);
    PlanSettings settings;
    settings.preset = kPresets[static_cast<std::size_t>(round % 5)];
    settings.paths = 1 + (round / 5) % 4;
    settings.speed = round % 7 == 0 ? kMaxFocusSpeed : random.uniform(1.0, kMaxFocusSpeed);
    settings.draw_rate = settings.speed / random.uniform(0.02, 0.2);
    const PresetTraits& traits = settings.traits();
    if (traits.takes_felt_weight() && round % 3 == 0) settings.felt_weight = 0.9;
    SCOPED_TRACE(testing::Message() << name_of(settings.preset) << ", " << settings.speed
                                    << " m/s, felt " << settings.felt_weight);
    if (traits.chooses_by_percept || settings.felt_weight > 0.0)
      settings.draw_rate = std::min(settings.draw_rate, 400.0);
    Planner planner(settings, frame.patches[0].size());
    Plan plan;
    PlanStats stats;
    ASSERT_EQ(planner.plan(frame.patches[0], plan, stats), PlanStatus::Planned);
    LiftedPlan lifted;
    lift(plan, frame, lifted);
    const PlayedPlan played = played_plan(lifted, kRate);
    EXPECT_EQ(played.changed_paths(), 0);
    for (std::size_t k = 0; k < plan.paths.size(); ++k)
      EXPECT_NEAR(plan.paths[k].period * kRate, played.paths[k].period * kRate, 1.001);
    expect_played(lifted, played, kMaxFocusSpeed);
    take_played(played, plan);
    for (std::size_t k = 0; k < plan.paths.size(); ++k) {
      EXPECT_EQ(plan.paths[k].period, played.paths[k].period);
      EXPECT_EQ(plan.paths[k].speed, played.paths[k].speed);
    }
  }
}

}  // namespace
}  // namespace prostm
