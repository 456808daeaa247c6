#include "prostm/plan/planner.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/textbook/textbook.hpp"
#include "random_fields.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using fields::Pattern;

PlanSettings preset(const std::string& name) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(name, "preset");
  return settings;
}

TargetField palm_of(int rows, int cols) {
  TargetField field;
  field.resize(rows, cols);
  field.cell = 5e-3;
  return field;
}

TEST(Planner, PlansEveryPatternWithFourPaths) {
  for (const char* name : {"paper", "paper-valid"}) {
    Planner planner(preset(name), fields::kCells * fields::kCells);
    for (const Pattern pattern : fields::kPatterns) {
      Plan plan;
      PlanStats stats;
      ASSERT_EQ(planner.plan(fields::make(pattern, 0), plan, stats), PlanStatus::Planned);
      ASSERT_NO_FATAL_FAILURE(test::expect_finite_plan(plan, 20));
      EXPECT_EQ(plan.paths.size(), static_cast<std::size_t>(std::min(stats.leaves, 4)));
      EXPECT_EQ(stats.clusters, 50);
      for (const FocalPath& path : plan.paths) EXPECT_NEAR(path.length, 0.140, 2.5e-3);
      EXPECT_EQ(stats.crossings, test::touching_pairs(plan));
      if (planner.settings().preset == Preset::PaperValid) {
        EXPECT_EQ(stats.long_paths, 0);
        ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, 20, 0.140));
      }
    }
  }
}

TEST(Planner, TheSameInputGivesTheSamePlanBitForBit) {
  for (const Pattern pattern : fields::kPatterns) {
    const TargetField field = fields::make(pattern, 3);
    Planner first(preset("paper-valid"), field.size()),
        second(preset("paper-valid"), kMaxFieldCells / 10);
    Plan a, b, c;
    PlanStats stats;
    first.plan(field, a, stats);
    // neither another planner nor a plan in between affects the result
    second.plan(fields::make(Pattern::Noise, 9), b, stats);
    second.plan(field, b, stats);
    first.plan(field, c, stats);
    ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(a, b, 1.0));
    ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(a, c, 1.0));
  }
}

TEST(Planner, APressureScaleOfAPowerOfTwoScalesOnlyThePressures) {
  for (const char* name : {"paper", "paper-valid", "best", "fast"}) {
    Planner planner(preset(name), fields::kCells * fields::kCells);
    for (const Pattern pattern : fields::kPatterns) {
      TargetField field = fields::make(pattern, 5);
      Plan plan, scaled;
      PlanStats stats;
      planner.reset();
      planner.plan(field, plan, stats);
      for (double& p : field.pressure) p *= 1024.0;
      planner.reset();
      planner.plan(field, scaled, stats);
      ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(plan, scaled, 1024.0));
    }
  }
}

constexpr std::array kUnits{0.1, 3.7, 10.0, 1000.0, 1e9, 1e-9};

TargetField in_unit(TargetField field, double unit) {
  for (double& p : field.pressure) p *= unit;
  return field;
}

/// Returns the gallery, and random fields with equal and nearly equal cells.
std::vector<TargetField> fields_for_units() {
  std::vector<TargetField> list;
  for (const Pattern pattern : fields::kPatterns) list.push_back(fields::make(pattern, 5));
  Random random(11);
  while (list.size() < 20) {
    const test::RandomField drawn = test::random_field(random, 40);
    const double most = drawn.kind == test::FieldKind::Invalid ? 0.0 : max_pressure(drawn.field);
    if (most > 1e-6 && most < 1e6) list.push_back(drawn.field);
  }
  return list;
}

TEST(Planner, TheUnitOfPressureDoesNotChangePaths) {
  const std::vector<TargetField> list = fields_for_units();
  for (const char* name : {"paper", "paper-valid", "best", "fast", "textbook"}) {
    const bool is_textbook = std::string(name) == "textbook";
    Planner planner(preset(is_textbook ? "paper" : name), fields::kCells * fields::kCells);
    const auto plan_of = [&](const TargetField& field) {
      Plan plan;
      PlanStats stats;
      planner.reset();
      if (is_textbook) {
        textbook::plan(field, planner.settings(), plan, stats);
      } else {
        planner.plan(field, plan, stats);
      }
      return plan;
    };
    for (std::size_t i = 0; i < list.size(); ++i) {
      const Plan plan = plan_of(list[i]);
      for (const double unit : kUnits) {
        SCOPED_TRACE(std::string(name) + ", field " + std::to_string(i));
        ASSERT_NO_FATAL_FAILURE(
            test::expect_scaled_plan(plan, plan_of(in_unit(list[i], unit)), unit));
      }
    }
  }
}

TEST(Planner, TheUnitOfPressureDoesNotChangeTheShares) {
  // two hands of equal total pressure, summed in another order
  TargetFrame frame;
  frame.patches.push_back(fields::make(Pattern::Noise, 5));
  frame.patches.push_back(fields::rotated(frame.patches[0]));
  PlanSettings settings = preset("fast");
  settings.paths = 3;
  Planner planner(settings, fields::kCells * fields::kCells);
  const auto plan_of = [&](const TargetFrame& hands) {
    Plan plan;
    PlanStats stats;
    planner.reset();
    planner.plan(hands, plan, stats);
    return plan;
  };
  const Plan plan = plan_of(frame);
  for (const double unit : kUnits) {
    TargetFrame scaled = frame;
    for (TargetField& patch : scaled.patches) patch = in_unit(patch, unit);
    ASSERT_NO_FATAL_FAILURE(test::expect_scaled_plan(plan, plan_of(scaled), unit)) << unit;
  }
}

TEST(Planner, DoesNotAllocate) {
  for (const char* name : {"paper", "paper-valid", "best", "fast"}) {
    Planner planner(preset(name), fields::kCells * fields::kCells);
    TargetFrame frame;
    frame.patches.push_back(fields::make(Pattern::OnePlume, 1));
    frame.patches.push_back(fields::make(Pattern::Noise, 1));
    Plan plan;
    PlanStats stats;
    const test::HeapGuard guard;
    planner.plan(frame.patches[0], plan, stats);
    planner.plan(frame.patches[1], plan, stats);
    planner.plan(frame, plan, stats);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST(Planner, DistinguishesEmptyAndInvalidTargets) {
  Planner planner(PlanSettings{}, 100);
  Plan plan;
  PlanStats stats;
  TargetField field = palm_of(10, 10);
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::EmptyTarget);
  field.skin.assign(field.size(), 1);
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::EmptyTarget);
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), 1e305}) {
    field.pressure[7] = bad;
    EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::InvalidTarget) << bad;
    EXPECT_TRUE(plan.paths.empty());
  }
  field.pressure[7] = 1.0;
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
  field.cell = 2.0;
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::InvalidTarget);
  EXPECT_EQ(planner.plan(palm_of(11, 10), plan, stats), PlanStatus::InvalidTarget);
}

TEST(Planner, AFewCellsGetOneLoopAroundThem) {
  Planner planner(preset("paper-valid"), 400);
  for (const int cells : {1, 2, 3, 5}) {
    TargetField field = palm_of(20, 20);
    for (int k = 0; k < cells; ++k) test::touch(field, 10, 8 + k, 1.0);
    Plan plan;
    PlanStats stats;
    ASSERT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
    ASSERT_EQ(plan.paths.size(), 1u);
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, 20, 0.140));
    Vec2 mean = Vec2::Zero();
    for (const Vec2& x : plan.paths[0].points) mean += x / 20.0;
    EXPECT_LT((mean - field.position(10, 8 + cells / 2)).norm(), 0.015) << cells;
  }
}

TEST(Planner, TraceHoldsTheStepsOfFigure2) {
  const TargetField field = fields::make(Pattern::OnePlume, 2);
  Planner planner(preset("paper"), field.size());
  Plan plan;
  PlanStats stats;
  PlanTrace trace;
  planner.plan(field, plan, stats, &trace);
  EXPECT_EQ(trace.clusters.size(), 50u);
  EXPECT_EQ(trace.tour.size(), 50u);
  ASSERT_EQ(trace.split.size(), plan.paths.size());
  double previous = std::numeric_limits<double>::max();
  for (const std::vector<int>& tour : trace.split) {
    double mass = 0.0, length = 0.0;
    for (std::size_t i = 0; i < tour.size(); ++i) {
      const auto a = static_cast<std::size_t>(tour[i]),
                 b = static_cast<std::size_t>(tour[(i + 1) % tour.size()]);
      mass += trace.cluster_mass[a];
      length += (trace.clusters[a] - trace.clusters[b]).norm();
    }
    EXPECT_LE(length, 0.140 + 1e-9);
    EXPECT_LE(mass, previous);
    previous = mass;
  }
}

TEST(Planner, SharesPathsOverTwoHands) {
  Planner planner(preset("paper-valid"), fields::kCells * fields::kCells);
  TargetFrame frame;
  frame.patches.push_back(fields::make(Pattern::OnePlume, 1));
  frame.patches.push_back(fields::make(Pattern::OnePlume, 1));
  Plan plan;
  PlanStats stats;
  const auto paths_of = [&](int patch) {
    return std::count_if(plan.paths.begin(), plan.paths.end(),
                         [&](const FocalPath& p) { return p.patch == patch; });
  };
  ASSERT_EQ(planner.plan(frame, plan, stats), PlanStatus::Planned);
  EXPECT_EQ(paths_of(0), 2);
  EXPECT_EQ(paths_of(1), 2);

  // a weak hand still gets one path, an empty hand none
  for (double& p : frame.patches[1].pressure) p *= 1e-3;
  ASSERT_EQ(planner.plan(frame, plan, stats), PlanStatus::Planned);
  EXPECT_EQ(paths_of(0), 3);
  EXPECT_EQ(paths_of(1), 1);
  for (double& p : frame.patches[1].pressure) p = 0.0;
  ASSERT_EQ(planner.plan(frame, plan, stats), PlanStatus::Planned);
  EXPECT_EQ(paths_of(0), 4);

  // equals the plan of a single target
  Plan single;
  planner.plan(frame.patches[0], single, stats);
  ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(single, plan, 1.0));

  frame.patches[1].pressure[0] = -1.0;
  EXPECT_EQ(planner.plan(frame, plan, stats), PlanStatus::InvalidTarget);
  EXPECT_TRUE(plan.paths.empty());
  EXPECT_EQ(planner.plan(TargetFrame{}, plan, stats), PlanStatus::EmptyTarget);
}

TEST(Planner, SettingsOutOfBoundsAreReported) {
  const auto message = [](PlanSettings settings) -> std::string {
    try {
      Planner planner(settings, 100);
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  PlanSettings settings;
  EXPECT_EQ(message(settings), "");
  settings.clusters = 0;
  EXPECT_EQ(message(settings), "clusters = 0 must be between 1 and 50");
  settings = {};
  settings.sigma = 0.0;
  EXPECT_EQ(message(settings), "sigma = 0 m must be between 0.0001 and 0.1 m");
  settings = {};
  settings.gain = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(settings).find("gain = "), std::string::npos);
}

/// Plans 10^4 fields of all kinds.
TEST(Planner, RandomFieldsGiveValidPlansOrTheStatedStatus) {
  constexpr int kMaxSide = 48;
  const test::Seeds seeds = test::seeds(10'000);
  Planner paper(preset("paper"), kMaxSide * kMaxSide),
      valid(preset("paper-valid"), kMaxSide * kMaxSide);
  std::uint64_t planned = 0, dropped = 0, crossing = 0, longer = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.end; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const test::RandomField input = test::random_field(random, kMaxSide);
    Plan plan, exact;
    PlanStats stats, exact_stats;
    const PlanStatus status = valid.plan(input.field, plan, stats);
    const bool empty =
        input.kind == test::FieldKind::NoSkin || input.kind == test::FieldKind::NoPressure;
    if (input.kind == test::FieldKind::Invalid) {
      ASSERT_EQ(status, PlanStatus::InvalidTarget);
    } else if (empty) {
      ASSERT_EQ(status, PlanStatus::EmptyTarget);
    }
    if (status != PlanStatus::Planned) {
      // borders and random masks may leave no pressure
      ASSERT_TRUE(plan.paths.empty());
      ASSERT_TRUE(status == PlanStatus::InvalidTarget || max_pressure(input.field) == 0.0);
      continue;
    }
    ++planned;
    ASSERT_GE(plan.paths.size(), 1u);
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, 20, 0.140));
    ASSERT_EQ(stats.crossings + stats.long_paths, 0);
    if (seed % 4 != 0) continue;
    ASSERT_EQ(paper.plan(input.field, exact, exact_stats), PlanStatus::Planned);
    ASSERT_NO_FATAL_FAILURE(test::expect_finite_plan(exact, 20));
    dropped += exact.paths.size() - plan.paths.size();
    crossing += exact_stats.crossings > 0 ? 1 : 0;
    longer += exact_stats.long_paths > 0 ? 1 : 0;
  }
  RecordProperty("planned", std::to_string(planned));
  RecordProperty("paper_plans_that_cross", std::to_string(crossing));
  RecordProperty("paper_plans_too_long", std::to_string(longer));
  RecordProperty("paths_dropped", std::to_string(dropped));
}

}  // namespace
}  // namespace prostm
