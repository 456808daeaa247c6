/// Plans of the presets best and fast on uneven skin.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "plan_checks.hpp"
#include "prostm/emit/detail/path_emitter.hpp"
#include "prostm/fields/skin_shapes.hpp"
#include "prostm/plan/detail/fit/spacing.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "random_fields.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using fields::SkinShape;

constexpr std::size_t kCells = static_cast<std::size_t>(fields::kCells) * fields::kCells;
constexpr double kLongest = 0.1405;  // [m]: L + 0.5 mm
constexpr double kSampleRate = 40e3;

PlanSettings preset(const std::string& name) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(name, "preset");
  return settings;
}

LiftedPlan lifted_on(const TargetField& field, const Plan& plan) {
  TargetFrame frame;
  frame.patches.push_back(field);
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  return lifted;
}

/// Checks for closed, simple paths without crossings, with the spacing in the plane, at most L long
/// on the skin, and with the period of that length.
void expect_valid_on_skin(const TargetField& field, const Plan& plan) {
  std::vector<Vec2> points;
  const LiftedPlan lifted = lifted_on(field, plan);
  ASSERT_EQ(lifted.paths.size(), plan.paths.size());
  for (std::size_t k = 0; k < plan.paths.size(); ++k) {
    const FocalPath& path = plan.paths[k];
    ASSERT_EQ(path.points.size(), plan.paths.front().points.size());
    for (const Vec2& x : path.points) {
      ASSERT_TRUE(std::isfinite(x.x()) && std::isfinite(x.y()));
      points.push_back(1e3 * x);
    }
    for (const double p : path.pressure) ASSERT_TRUE(std::isfinite(p) && p >= 0.0);
    ASSERT_DOUBLE_EQ(path.length, closed_length(path));
    ASSERT_GT(path.length, 0.0);
    ASSERT_LE(lifted.paths[k].length, kLongest) << "path " << k << ", in the plane " << path.length;
    ASSERT_NEAR(path.period, lifted.paths[k].length / path.speed, 1e-6 * path.period);
  }
  ASSERT_EQ(test::touching_pairs(plan), 0);
  planning::SpacingRule rule;
  rule.spacing = 0.9 * 8.6 - 1e-3;
  rule.along = 2.0 * 8.6 + 1e-3;
  const auto samples = static_cast<int>(plan.paths.front().points.size());
  ASSERT_EQ(planning::count_near_pairs(points, samples, rule), 0);
}

double step(const FocusSample& a, const FocusSample& b) {
  return (b.p_D.cast<double>() - a.p_D.cast<double>()).norm();
}

/// Plays a single path for some laps.
std::vector<FocusSample> play(const LiftedPath& path, std::size_t samples) {
  EmitSettings settings;
  settings.foci = 1;
  settings.full_scale_pressure = 1.0;
  PathEmitter emitter(settings, kSampleRate);
  emitter.draft().paths.clear();
  emitter.draft().paths.push_back(path);
  emitter.draft().id = 1;
  emitter.submit();
  std::vector<FocusSample> out(samples);
  emitter.fill(0, out);
  return out;
}

/// Checks the emission of a path: its speed on the skin, and the time of a lap.
void expect_speed_and_period(const LiftedPath& lifted, const FocalPath& path) {
  const auto lap = static_cast<std::size_t>(std::ceil(lifted.length * kSampleRate / path.speed));
  ASSERT_NEAR(static_cast<double>(lap), path.period * kSampleRate, 1.0 + 1e-6);
  const std::vector<FocusSample> samples = play(lifted, 2 * lap + 1);
  ASSERT_EQ(samples[lap / 3].p_D, samples[lap / 3 + lap].p_D);
  const double even = 7.0 / kSampleRate;
  double travelled = 0.0;
  std::size_t slow = 0;
  for (std::size_t i = 0; i < lap; ++i) {
    const double d = step(samples[i], samples[i + 1]);
    travelled += d;
    ASSERT_LE(d, 1.005 * even);
    slow += d < 0.98 * even ? 1 : 0;
  }
  // a step across a corner is shorter than the path between its ends
  const std::size_t corners = lifted.p_D.size();
  ASSERT_LE(slow, corners / 5) << "of " << lap << ", with " << corners << " corners";
  ASSERT_NEAR(travelled / static_cast<double>(lap), even, 0.02 * even);
}

class OnSkin : public testing::TestWithParam<const char*> {};

TEST_P(OnSkin, LengthSpeedAndPeriodAreThoseOnTheSkin) {
  Planner planner(preset(GetParam()), kCells);
  double longest = 0.0, most_stretched = 1.0;
  for (const SkinShape shape : fields::kSkinShapes) {
    for (const bool in_voxels : {false, true}) {
      for (const fields::Pattern pattern : fields::kPatterns) {
        planner.reset();
        for (const int frame : {20, 21, 60}) {
          SCOPED_TRACE(to_string(shape) + (in_voxels ? " in voxels, " : ", ") + to_string(pattern) +
                       " " + std::to_string(frame));
          const TargetField field =
              fields::with_skin(fields::make(pattern, frame), shape, in_voxels);
          Plan plan;
          PlanStats stats;
          ASSERT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
          ASSERT_NO_FATAL_FAILURE(expect_valid_on_skin(field, plan));
          const LiftedPlan lifted = lifted_on(field, plan);
          for (std::size_t k = 0; k < plan.paths.size(); ++k) {
            const double length = lifted.paths[k].length;
            longest = std::max(longest, length);
            most_stretched = std::max(most_stretched, length / plan.paths[k].length);
            ASSERT_NO_FATAL_FAILURE(expect_speed_and_period(lifted.paths[k], plan.paths[k]));
          }
        }
      }
    }
  }
  // the shapes do lengthen paths, and plans account for it
  EXPECT_GT(most_stretched, 1.3);
  EXPECT_GT(longest, 0.1385);
  RecordProperty("longest_mm", std::to_string(1e3 * longest));
}
INSTANTIATE_TEST_SUITE_P(Presets, OnSkin, testing::Values("best", "fast"));

/// Adds bumps and hollows, smooth or in voxels, up to slopes that no hand has; on one skin in ten
/// no neighbouring cells have equal height.
void make_bumpy(TargetField& field, Random& random) {
  const double steepest = std::pow(10.0, random.uniform(-2.0, 1.0));
  const double voxel = random.uniform() < 0.3 ? fields::kVoxel : 0.0;
  if (random.uniform() < 0.1) {
    for (double& h : field.height) h = steepest * field.cell * random.uniform(-1.0, 1.0);
    return;
  }
  const int bumps = 1 + random.below(12);
  for (int k = 0; k < bumps; ++k) {
    const double r = random.uniform(0, field.rows), c = random.uniform(0, field.cols);
    const double width = random.uniform(1.5, 10.0);  // in cells
    const double height = random.uniform(-1.0, 1.0) * steepest * width * field.cell;
    for (int row = 0; row < field.rows; ++row) {
      for (int col = 0; col < field.cols; ++col) {
        field.height[field.index(row, col)] +=
            height *
            std::exp(-0.5 * (std::pow((row - r) / width, 2) + std::pow((col - c) / width, 2)));
      }
    }
  }
  if (voxel == 0.0) return;
  for (double& h : field.height) h = voxel * std::round(h / voxel);
}

TEST(OnBumpySkin, RandomPlansAreValidAndNeverTooLong) {
  constexpr int kMaxSide = 48;
  Planner fast(preset("fast"), kMaxSide * kMaxSide);
  PlanSettings brief = preset("best");
  brief.fit_starts = 2;
  brief.fit_kicks = 1;
  Planner best(brief, kMaxSide * kMaxSide);
  const std::uint64_t count = test::reduced(1'000);
  std::uint64_t planned = 0, seed = 0;
  for (; planned < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    test::RandomField input = test::random_field(random, kMaxSide);
    if (input.kind == test::FieldKind::Invalid) continue;
    make_bumpy(input.field, random);
    Plan plan;
    PlanStats stats;
    Planner& planner = seed % 4 == 0 ? best : fast;
    // half of them continue from a plan for another target
    if (seed % 8 < 4) planner.reset();
    if (planner.plan(input.field, plan, stats) != PlanStatus::Planned) continue;
    ++planned;
    ASSERT_GE(plan.paths.size(), 1U);
    ASSERT_NO_FATAL_FAILURE(expect_valid_on_skin(input.field, plan));
  }
}

}  // namespace
}  // namespace prostm
