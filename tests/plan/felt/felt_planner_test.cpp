/// The preset `felt`, and its rules for the number of paths.

#include "prostm/plan/detail/fit/felt/felt_planner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "plan/plan_checks.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/fit/felt/plain_loops.hpp"
#include "prostm/plan/felt_plan.hpp"
#include "prostm/score/score.hpp"
#include "support/heap_guard.hpp"

namespace prostm::planning {
namespace {

constexpr double kSigma = 4.3e-3;

PlanSettings felt(double strength_weight) {
  PlanSettings settings;
  settings.preset = Preset::Felt;
  settings.sigma = kSigma;
  settings.strength_weight = strength_weight;
  return settings;
}

/// The same, with time to compare all plans, but not to refine any.
PlanSettings quickly_felt(double strength_weight) {
  PlanSettings settings = felt(strength_weight);
  settings.budget = 0.3;
  return settings;
}

/// Returns the number of regions by merging the labels of neighbours until none differ.
int merged_regions(const TargetField& field, double least) {
  std::vector<int> label(field.size());
  std::iota(label.begin(), label.end(), 0);
  const auto counts = [&](int row, int col) {
    if (row < 0 || col < 0 || row >= field.rows || col >= field.cols) return false;
    const std::size_t i = field.index(row, col);
    return field.skin[i] != 0 && field.pressure[i] >= least;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int row = 0; row < field.rows; ++row) {
      for (int col = 0; col < field.cols; ++col) {
        if (!counts(row, col)) continue;
        int& own = label[field.index(row, col)];
        for (int r = row - 1; r <= row + 1; ++r) {
          for (int c = col - 1; c <= col + 1; ++c) {
            if (!counts(r, c) || label[field.index(r, c)] >= own) continue;
            own = label[field.index(r, c)];
            changed = true;
          }
        }
      }
    }
  }
  int regions = 0;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      if (counts(row, col) && label[i] == static_cast<int>(i)) ++regions;
    }
  }
  return regions;
}

TEST(RegionCounter, CountsLikeMergedLabels) {
  RegionCounter counter(12 * 12);
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    Random random(seed);
    TargetField field;
    field.resize(1 + random.below(12), 1 + random.below(12));
    const double share = random.uniform(0.0, 1.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
      field.skin[i] = random.below(5) > 0 ? 1 : 0;
      if (field.skin[i] != 0) field.pressure[i] = random.uniform(0.0, 1.0) < share ? 0.26 : 0.24;
    }
    const test::HeapGuard guard;
    const int counted = counter.count(field, 1.0);
    ASSERT_EQ(guard.allocations(), 0U);
    ASSERT_EQ(counted, merged_regions(field, RegionCounter::kLeast)) << "seed " << seed;
  }
}

TEST(PathCount, MayChangeOnceASecondOrWithTheRegions) {
  PathCount count;
  count.begin(1, 10.0);
  EXPECT_TRUE(count.may_change());
  EXPECT_EQ(count.paths(), 0);
  count.take(2);
  EXPECT_EQ(count.paths(), 2);
  count.begin(1, 10.5);
  EXPECT_FALSE(count.may_change());
  count.take(2);
  count.begin(2, 10.6);
  EXPECT_TRUE(count.may_change()) << "another region";
  count.take(3);
  count.begin(2, 11.55);
  EXPECT_FALSE(count.may_change());
  count.begin(2, 11.65);
  EXPECT_TRUE(count.may_change());
  count.take(3);
  count.begin(2, 11.7);
  EXPECT_TRUE(count.may_change()) << "the last change was more than a second ago";
  count.take(1);
  count.begin(2, 0.0);
  EXPECT_TRUE(count.may_change()) << "another recording";
  count.forget();
  EXPECT_EQ(count.paths(), 0);
}

TEST(PlainLoops, HaveTheMomentsOfThePressure) {
  constexpr LoopBounds kBounds{.least_length = 35.0, .most_length = 300.0, .width = 6.0};
  for (const double angle : {0.0, 0.4, 1.3, -0.7}) {
    TargetField ring, bar;
    for (TargetField* field : {&ring, &bar}) {
      field->resize(90, 100);
      field->cell = 2e-3;
      std::fill(field->skin.begin(), field->skin.end(), std::uint8_t{1});
    }
    const Vec2 centre(0.096, 0.083), along(std::cos(angle), std::sin(angle));
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 x = ring.position(i) - centre;
      ring.pressure[i] = std::exp(-std::pow((x.norm() - 0.03) / 4e-3, 2));
      bar.pressure[i] =
          std::abs(x.dot(along)) < 0.05 && std::abs(cross(along, x)) < 4e-3 ? 2.0 : 0.0;
    }
    Loops loops;
    loops.samples = 20;
    start_circle(ring, kBounds, loops);
    ASSERT_EQ(loops.paths, 1);
    for (int i = 0; i < 20; ++i) EXPECT_NEAR((loops.point(i, 0) - 1e3 * centre).norm(), 30.3, 0.3);
    start_line(bar, kBounds, loops);
    double reach = 0.0;
    for (int i = 0; i < 20; ++i) {
      const Vec2 x = loops.point(i, 0) - 1e3 * centre;
      reach = std::max(reach, std::abs(x.dot(along)));
      EXPECT_LE(std::abs(cross(along, x)), 3.0 + 1.0);
      const double side = (loops.point((i + 1) % 20, 0) - loops.point(i, 0)).norm();
      EXPECT_NEAR(side, 10.0, 1.5) << "evenly spaced";
    }
    EXPECT_NEAR(reach, 50.0, 1.5);
  }
}

/// Lack and largest percept of plans for several patterns, summed.
struct Felt {
  double lack = 0.0, strength = 0.0;
  std::size_t paths = 0;
};

Felt felt_of(const PlanSettings& settings) {
  Felt sum;
  for (const fields::Pattern pattern : {fields::Pattern::FourPlumes, fields::Pattern::Ring,
                                        fields::Pattern::Letter, fields::Pattern::Palm}) {
    const TargetField field = fields::make(pattern, 40);
    const Plan plan = test::plan_of(settings, field);
    const FeltPlan found = felt_plan(plan, field, kSigma, felt_skins());
    sum.lack += found.lack;
    // an upper bound of the output (P20)
    double most = 0.0;
    for (const FocalPath& path : plan.paths)
      most += *std::max_element(path.pressure.begin(), path.pressure.end());
    sum.strength += std::log(
        *std::max_element(found.percept.front().begin(), found.percept.front().end()) / most);
    sum.paths += plan.paths.size();
  }
  return sum;
}

std::pair<Plan, PlanStats> planned(const PlanSettings& settings, const TargetField& field) {
  std::pair<Plan, PlanStats> out;
  Planner(settings, field.size()).plan(field, out.first, out.second);
  return out;
}

TEST(FeltPreset, TradesShapeForStrength) {
  const Felt shape = felt_of(felt(0.0)), both = felt_of(felt(0.1)), strength = felt_of(felt(5.0));
  EXPECT_LE(shape.lack, both.lack * 1.02);
  EXPECT_LT(both.lack, strength.lack);
  EXPECT_GT(strength.strength, shape.strength);
  EXPECT_EQ(strength.paths, 4U) << "one path is felt most strongly";
  EXPECT_GT(shape.paths, 6U);
}

/// A ring of a radius of 22 mm on a plane of skin.
TargetField ring(double cell, const Vec2& centre) {
  constexpr double kEdge = 0.12, kRadius = 22e-3, kWidth = 6e-3;
  const int cells = static_cast<int>(std::lround(kEdge / cell));
  TargetField field;
  field.resize(cells, cells);
  field.cell = cell;
  field.origin = Vec2::Constant(-0.5 * cell * (cells - 1));
  for (int row = 0; row < cells; ++row) {
    for (int col = 0; col < cells; ++col) {
      const std::size_t i = field.index(row, col);
      const Vec2 at = field.origin + cell * Vec2(col, row);
      field.skin[i] = 1;
      field.pressure[i] = std::exp(-0.5 * std::pow(((at - centre).norm() - kRadius) / kWidth, 2));
    }
  }
  return field;
}

/// How often a closed path goes round a point.
template <class Points>
int turns_around(const Points& points, const Vec2& centre) {
  double angle = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 from = points[i] - centre, to = points[(i + 1) % points.size()] - centre;
    angle += std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  }
  return static_cast<int>(std::lround(angle / (2.0 * kPi)));
}

// More paths would cross its middle, which the model of the skin hardly feels.
TEST(FeltPreset, DrawsARingWithOnePathAroundIt) {
  PlanSettings settings = felt(0.1);
  settings.sigma = 4.75e-3;
  for (const double cell : {1.5e-3, 2e-3, 2.5e-3}) {
    for (const Vec2& centre : {Vec2(0.0, 0.0), Vec2(3e-3, -2e-3)}) {
      const TargetField field = ring(cell, centre);
      const Plan plan = planned(settings, field).first;
      ASSERT_EQ(plan.paths.size(), 1U) << cell << ' ' << centre.transpose();
      EXPECT_EQ(std::abs(turns_around(plan.paths[0].points, centre)), 1);
      EXPECT_LT(score_plan(field, plan, 0, settings.sigma, settings.gain_law()).spill, 0.06);
    }
  }
}

TEST(FeltPreset, IsFeltBetterThanPressuresOfTheField) {
  PlanSettings fast = felt(0.0);
  fast.preset = Preset::Fast;
  fast.felt_weight = 1e-6;  // in step, with the pressures of the fit
  EXPECT_LT(felt_of(felt(0.1)).lack, 0.6 * felt_of(fast).lack);
}

TEST(FeltPreset, RefinesPlansIfThereIsTime) {
  PlanSettings short_budget = felt(0.0), ample_budget = felt(0.0);
  short_budget.budget = 1e-6;
  ample_budget.budget = 60.0;
  const TargetField field = fields::make(fields::Pattern::Letter, 40);
  const auto [shortly, short_stats] = planned(short_budget, field);
  const auto [fully, full_stats] = planned(felt(0.0), field);
  const auto [amply, ample_stats] = planned(ample_budget, field);
  EXPECT_LT(short_stats.cost_evaluations, full_stats.cost_evaluations);
  ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(fully, amply, 1.0));
  const auto lack = [&](const Plan& plan) {
    return felt_plan(plan, field, kSigma, felt_skins()).lack;
  };
  EXPECT_LT(lack(fully), 0.9 * lack(shortly));
}

TEST(FeltPreset, KeepsTheNumberOfPathsForASecond) {
  Planner planner(quickly_felt(0.1), fields::kCells * fields::kCells);
  RegionCounter counter(fields::kCells * fields::kCells);
  std::size_t last = 0;
  int regions = 0;
  double changed = -1.0;
  for (int frame = 0; frame < 100; ++frame) {
    TargetFrame targets;
    targets.time = 0.04 * frame;
    targets.patches.push_back(fields::make(fields::Pattern::FourPlumes, frame));
    const int now = counter.count(targets.patches[0], max_pressure(targets.patches[0]));
    Plan plan;
    PlanStats stats;
    const test::HeapGuard guard;
    ASSERT_EQ(planner.plan(targets, plan, stats), PlanStatus::Planned);
    ASSERT_EQ(guard.allocations(), 0U);
    if (now != regions) changed = -1.0;
    regions = now;
    if (last != 0 && plan.paths.size() != last) {
      EXPECT_GE(targets.time, changed + PathCount::kHold - 1e-9) << "frame " << frame;
      changed = targets.time;
    }
    last = plan.paths.size();
  }
}

/// Distance of the point of `from` that is farthest from every point of `to` [m].
double farthest(const Plan& from, const Plan& to) {
  double most = 0.0;
  for (const FocalPath& path : from.paths) {
    for (const Vec2& x : path.points) {
      double least = 1.0;
      for (const FocalPath& other : to.paths)
        for (const Vec2& y : other.points) least = std::min(least, (x - y).norm());
      most = std::max(most, least);
    }
  }
  return most;
}

/// Adds a row and a column without skin on the side of the origin.
TargetField with_margin(const TargetField& field) {
  TargetField out = field;
  out.resize(field.rows + 1, field.cols + 1);
  out.origin -= Vec2(field.cell, field.cell);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t from = field.index(row, col), to = out.index(row + 1, col + 1);
      out.skin[to] = field.skin[from];
      out.pressure[to] = field.pressure[from];
    }
  }
  return out;
}

TEST(FeltPreset, PlansForATargetThatStaysAreAlike) {
  const TargetField field = fields::make(fields::Pattern::Letter, 40);
  Planner planner(felt(0.0), with_margin(field).size());
  const auto lack = [&](const Plan& plan) {
    return felt_plan(plan, field, kSigma, felt_skins()).lack;
  };
  Plan first, last, plan;
  PlanStats stats;
  ASSERT_EQ(planner.plan(field, first, stats), PlanStatus::Planned);
  last = first;
  for (int i = 0; i < 8; ++i) {
    ASSERT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
    EXPECT_LT(farthest(plan, last), 6e-3) << "plan " << i;
    last = plan;
  }
  EXPECT_LT(lack(last), lack(first) + 0.005);
  ASSERT_EQ(planner.plan(with_margin(field), plan, stats), PlanStatus::Planned);
  EXPECT_LT(farthest(plan, last), 6e-3) << "the raster has another origin";
}

/// Returns the last of `plans` plans for a target that costs more than the one planned before.
Plan after_a_simpler_target(const PlanSettings& settings, const TargetField& target, int plans) {
  Planner planner(settings, target.size());
  Plan plan;
  PlanStats stats;
  planner.plan(fields::make(fields::Pattern::OnePlume, 10), plan, stats);
  for (int i = 0; i < plans; ++i) {
    EXPECT_EQ(planner.plan(target, plan, stats), PlanStatus::Planned);
  }
  return plan;
}

TEST(FeltPreset, ChoosesAmongAllPlansAgainWhenItHasBecomeWorse) {
  const TargetField target = fields::make(fields::Pattern::Noise, 10);
  ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(
      test::plan_of(felt(0.1), target), after_a_simpler_target(felt(0.1), target, 1), 1.0));
}

TEST(FeltPreset, MakesPlansAnewByTurnsIfThereIsNoTimeForAll) {
  PlanSettings quick = felt(0.1);
  quick.budget = 1e-6;
  Planner planner(quick, fields::kCells * fields::kCells);
  std::size_t paths = 0;
  const auto plan = [&](fields::Pattern pattern, int frame) {
    TargetFrame targets;
    targets.time = 0.04 * frame;
    targets.patches.push_back(fields::make(pattern, 10));
    Plan out;
    PlanStats stats;
    EXPECT_EQ(planner.plan(targets, out, stats), PlanStatus::Planned);
    paths = out.paths.size();
  };
  for (int frame = 0; frame < 40; ++frame) plan(fields::Pattern::Fingertips, frame);
  EXPECT_EQ(paths, 4U) << "there is no time to compare";
  for (int frame = 40; frame < 80; ++frame) plan(fields::Pattern::OnePlume, frame);
  EXPECT_EQ(paths, 1U) << "the last plan costs much more, so others were made by turns";
}

TEST(FeltPreset, PlansEachHandAndForgetsOneThatLeft) {
  Planner planner(felt(0.1), fields::kCells * fields::kCells);
  TargetFrame both, first;
  both.patches.push_back(fields::make(fields::Pattern::OnePlume, 10));
  both.patches.push_back(fields::make(fields::Pattern::FourPlumes, 10));
  first.patches.push_back(both.patches[0]);
  Plan plan, again;
  PlanStats stats;
  ASSERT_EQ(planner.plan(both, plan, stats), PlanStatus::Planned);
  EXPECT_LE(plan.paths.size(), 4U);
  for (const int patch : {0, 1}) {
    EXPECT_TRUE(std::any_of(plan.paths.begin(), plan.paths.end(),
                            [&](const FocalPath& path) { return path.patch == patch; }));
  }
  planner.plan(first, again, stats);
  planner.reset();
  planner.plan(both, again, stats);
  ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(plan, again, 1.0));
}

}  // namespace
}  // namespace prostm::planning
