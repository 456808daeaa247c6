/// Fields with weights, which give some errors more influence: (P17).

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gradient_check.hpp"
#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/initial_loops.hpp"
#include "prostm/plan/detail/fit/raster/cell_weights.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/target/pressure_share.hpp"
#include "random_fields.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm::planning {
namespace {

using fields::Pattern;

constexpr std::size_t kCells = static_cast<std::size_t>(fields::kCells) * fields::kCells;
constexpr double kSigma = 8.6e-3;
constexpr GainLaw kGain;

PlanSettings preset(const std::string& name) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(name, "preset");
  return settings;
}

Plan plan_of(const TargetField& field, const PlanSettings& settings) {
  Planner planner(settings, field.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
  return plan;
}

/// Returns a frame of a pattern whose upper rows have the weight `upper` and the others `lower`.
TargetField halved(Pattern pattern, int frame, double upper, double lower) {
  TargetField field = fields::make(pattern, frame);
  field.weight.assign(field.size(), lower);
  for (std::size_t i = field.index(field.rows / 2, 0); i < field.size(); ++i) {
    field.weight[i] = upper;
  }
  return field;
}

/// Returns a flat palm with one round contact at each given column of the middle row.
TargetField contacts(std::initializer_list<int> columns) {
  TargetField field;
  field.resize(25, 45);
  field.cell = 3e-3;
  field.skin.assign(field.size(), 1);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      for (const int at : columns) {
        field.pressure[field.index(row, col)] +=
            std::exp(-0.5 * (std::pow(row - 12, 2) + std::pow(col - at, 2)) / 9.0);
      }
    }
  }
  return field;
}

TEST(CellWeights, AreRelativeToTheirMeanByPressure) {
  const TargetField field = halved(Pattern::OnePlume, 3, 5.0, 0.5);
  const CellWeights weights(field, max_pressure(field));
  double weighted = 0.0, all = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] == 0) continue;
    const double p = pressure_share(field.pressure[i], max_pressure(field));
    weighted += weights[i] * p;
    all += p;
  }
  EXPECT_NEAR(weighted, all, 1e-12 * all);
  EXPECT_NEAR(weights[field.size() - 1], 10.0 * weights[0], 1e-12 * weights[field.size() - 1]);
  EXPECT_TRUE(weights.any_pressure());
}

TEST(CellTiles, AverageABlockByItsWeights) {
  // two blocks of two cells: weights 1 and 3 in the first, 0 in the second
  TargetField field;
  field.resize(1, 4);
  field.cell = 2e-3;
  field.skin.assign(4, 1);
  field.pressure = {1.0, 0.5, 0.25, 0.75};
  field.weight = {2.0, 6.0, 0.0, 0.0};
  CellTiles cells(4);
  cells.set(field, 1.0, 4.0);
  ASSERT_EQ(cells.tiles().size(), 1U);
  const CellTile& tile = cells.tiles()[0];
  EXPECT_FLOAT_EQ(tile.x[0], 1.5F);  // 0 and 2 mm
  EXPECT_FLOAT_EQ(tile.y[0], 0.0F);
  EXPECT_FLOAT_EQ(tile.pressure[0], 0.625F);
  // Σ w p* / Σ p* is 5 / 2.5 = 2, so the mean weight is (1 + 3) / 2; a cell has unit area
  EXPECT_FLOAT_EQ(cells.mean_weight(0, 0), 2.0F);
  EXPECT_FLOAT_EQ(tile.weight[0], 4.0F);
  EXPECT_FLOAT_EQ(cells.peak(), 1.25F);
  EXPECT_EQ(tile.weight[1], 0.0F);
  EXPECT_EQ(cells.mean_weight(0, 1), 0.0F);
}

TEST(CellTiles, PreserveTheWeightedMassOfTheTarget) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    TargetField field = fields::make(fields::kPatterns[seed % fields::kPatterns.size()], 2);
    test::add_weights(field, random);
    if (max_weight(field) == 0.0) continue;
    const double maximum = max_pressure(field);
    if (!CellWeights(field, maximum).any_pressure()) continue;
    double mass = 0.0, tiled = 0.0;
    for (const double p : field.pressure) mass += p / maximum;
    CellTiles cells(kCells);
    cells.set(field, maximum, 4.0);
    for (const CellTile& tile : cells.tiles()) {
      for (std::size_t c = 0; c < 8; ++c) {
        tiled += static_cast<double>(tile.weight[c]) * static_cast<double>(tile.pressure[c]);
        EXPECT_TRUE(std::isfinite(tile.x[c]) && std::isfinite(tile.y[c]));
      }
    }
    EXPECT_NEAR(tiled, mass, 1e-3 * mass) << seed;
  }
}

TEST(InitialLoops, VisitOnlyWeightedContacts) {
  // both contacts, but only one if the other has less than 1 % of its weight
  for (const double right : {1.0, 5e-3}) {
    TargetField field = contacts({12, 32});
    field.weight.assign(field.size(), 1.0);
    for (std::size_t i = 0; i < field.size(); ++i) {
      if (i % 45 >= 22) field.weight[i] = right;
    }
    CellTiles cells(field.size());
    cells.set(field, max_pressure(field), 4.0);
    InitialLoops initial(field.size());
    initial.set(cells, 0.01F);
    Random random(1);
    StartSettings start;
    start.paths = 1;
    start.most_length = 300.0;
    Loops loops;
    initial.make(start, 20, random, loops);
    double farthest = 0.0;
    for (int i = 0; i < loops.samples; ++i) {
      farthest = std::max(farthest, loops.point(i, 0).x());
    }
    EXPECT_EQ(farthest < 3.0 * 22, right < 1.0) << farthest;
  }
}

/// Loops on a pattern with weights, and the cells to render.
struct Case {
  CellTiles cells{kCells};
  Loops loops;

  explicit Case(std::uint64_t seed) {
    const auto frame = static_cast<int>(seed);
    const TargetField field = halved(fields::kPatterns[seed % fields::kPatterns.size()], frame, 4.0,
                                     seed % 2 == 0 ? 0.0 : 0.5);
    cells.set(field, max_pressure(field), 4.0);
    InitialLoops initial(kCells);
    initial.set(cells, 0.01F);
    Random random(seed);
    initial.make(StartSettings{}, 20, random, loops);
  }
};

TEST(Descent, WeightedGradientAgreesWithCentralDifferences) {
  test::GradientCheck check;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Case c(seed);
    check.add(c.cells, c.loops);
  }
  check.expect_agreement();
}

TEST(Weights, OfOneEverywhereEqualNone) {
  for (const char* name : {"best", "fast"}) {
    for (const Pattern pattern : fields::kPatterns) {
      const TargetField field = fields::make(pattern, 7);
      const Plan without = plan_of(field, preset(name));
      const Plan with = plan_of(halved(pattern, 7, 1.0, 1.0), preset(name));
      ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(without, with, 1.0));
    }
  }
}

TEST(Weights, ACommonFactorDoesNotMatter) {
  for (const char* name : {"best", "fast"}) {
    for (const Pattern pattern : fields::kPatterns) {
      const Plan plan = plan_of(halved(pattern, 7, 4.0, 1.0), preset(name));
      for (const double factor : {3.0, 0.1, 1e-300, 1e300}) {
        const Plan scaled = plan_of(halved(pattern, 7, 4.0 * factor, factor), preset(name));
        ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(plan, scaled, 1.0));
      }
    }
  }
}

TEST(Weights, DoNotAffectThePapersPresets) {
  for (const char* name : {"paper", "paper-valid"}) {
    const Plan without = plan_of(fields::make(Pattern::OnePlume, 7), preset(name));
    const Plan with = plan_of(halved(Pattern::OnePlume, 7, 4.0, 0.0), preset(name));
    ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(without, with, 1.0));
  }
}

TEST(Weights, OnePathGoesToTheContactWithMoreWeight) {
  for (const char* name : {"best", "fast"}) {
    PlanSettings settings = preset(name);
    settings.paths = 1;
    for (const bool left : {true, false}) {
      // so far apart that no path can render both
      TargetField field = contacts({4, 40});
      field.weight.assign(field.size(), 1.0);
      for (int row = 0; row < field.rows; ++row) {
        for (int col = 0; col < field.cols; ++col) {
          if ((col < 22) == left) field.weight[field.index(row, col)] = 3.0;
        }
      }
      const Plan plan = plan_of(field, settings);
      ASSERT_EQ(plan.paths.size(), 1U);
      Vec2 mean = Vec2::Zero();
      for (const Vec2& x : plan.paths[0].points) {
        mean += x / static_cast<double>(plan.paths[0].points.size());
      }
      EXPECT_LT((mean - field.position(12, left ? 4 : 40)).norm(), 12e-3) << name;
    }
  }
}

/// Returns the root mean squared error over rows [first, last), relative to the largest pressure.
double rmse_of_rows(const TargetField& field, const Plan& plan, int first, int last) {
  std::vector<double> rendered(field.size());
  quasi_static_field(plan, 0, field, kSigma, kGain, rendered);
  double sum = 0.0, cells = 0.0;
  for (std::size_t i = field.index(first, 0); i < field.index(last, 0); ++i) {
    if (field.skin[i] == 0) continue;
    sum += std::pow(rendered[i] - field.pressure[i], 2);
    cells += 1.0;
  }
  return std::sqrt(sum / cells) / max_pressure(field);
}

/// `./run bench planner` prints the size of the effect for every pattern.
TEST(Weights, LowerTheErrorWhereTheyAreLarge) {
  double upper = 0.0, lower = 0.0;
  for (const Pattern pattern : fields::kPatterns) {
    for (const int frame : {10, 50}) {
      const TargetField field = fields::make(pattern, frame);
      const Plan without = plan_of(field, preset("best"));
      const Plan with = plan_of(halved(pattern, frame, 4.0, 1.0), preset("best"));
      const int middle = field.rows / 2;
      upper += std::log(rmse_of_rows(field, with, middle, field.rows) /
                        rmse_of_rows(field, without, middle, field.rows));
      lower +=
          std::log(rmse_of_rows(field, with, 0, middle) / rmse_of_rows(field, without, 0, middle));
    }
  }
  const double count = 2.0 * fields::kPatterns.size();
  std::printf("upper half weighed 4 times: RMSE %+.1f %% there, %+.1f %% in the lower\n",
              100.0 * (std::exp(upper / count) - 1.0), 100.0 * (std::exp(lower / count) - 1.0));
  EXPECT_LT(std::exp(upper / count), 0.95);
  EXPECT_GT(lower, 0.0);
}

TEST(Weights, OfZeroOnAllPressureGiveAnEmptyTarget) {
  // pressure on the left, weight on the right
  TargetField field = contacts({8});
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 22; col < field.cols; ++col) field.pressure[field.index(row, col)] = 0.0;
  }
  field.weight.assign(field.size(), 0.0);
  field.weight[field.index(12, 40)] = 1.0;
  Plan plan;
  PlanStats stats;
  for (const char* name : {"best", "fast"}) {
    Planner planner(preset(name), kCells);
    EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::EmptyTarget);
    EXPECT_TRUE(plan.paths.empty());

    // the other hand gets all paths
    TargetFrame frame;
    frame.patches.push_back(field);
    frame.patches.push_back(fields::make(Pattern::Palm, 1));
    EXPECT_EQ(planner.plan(frame, plan, stats), PlanStatus::Planned);
    EXPECT_EQ(plan.paths.size(), 4U);
    for (const FocalPath& path : plan.paths) EXPECT_EQ(path.patch, 1);
  }
  Planner paper(preset("paper-valid"), kCells);
  EXPECT_EQ(paper.plan(field, plan, stats), PlanStatus::Planned);
}

TEST(Weights, InvalidOnesGiveAnInvalidTarget) {
  const TargetField good = halved(Pattern::Palm, 1, 2.0, 1.0);
  Plan plan;
  PlanStats stats;
  Planner planner(preset("fast"), kCells);
  for (const double bad :
       {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TargetField field = good;
    field.weight[5] = bad;
    EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::InvalidTarget);
  }
  TargetField field = good;
  field.weight.pop_back();
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::InvalidTarget);
  field.weight.assign(field.size(), 0.0);
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::InvalidTarget);
  EXPECT_EQ(planner.plan(good, plan, stats), PlanStatus::Planned);
}

TEST(Weights, AllocateNothing) {
  for (const char* name : {"best", "fast"}) {
    Planner planner(preset(name), kCells);
    const TargetField field = halved(Pattern::Noise, 1, 2.0, 1.0);
    Plan plan;
    PlanStats stats;
    const test::HeapGuard guard;
    planner.plan(field, plan, stats);
    EXPECT_EQ(guard.allocations(), 0U);
  }
}

TEST(Weights, OfAnyKindGiveValidPlans) {
  constexpr int kMaxSide = 48;
  const std::uint64_t count = test::reduced(4'000);
  PlanSettings brief = preset("best");
  brief.fit_starts = 2;
  brief.fit_kicks = 1;
  Planner fast(preset("fast"), kMaxSide * kMaxSide), best(brief, kMaxSide * kMaxSide);
  std::uint64_t planned = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    test::RandomField input = test::random_field(random, kMaxSide);
    test::add_weights(input.field, random);
    Plan plan;
    PlanStats stats;
    Planner& planner = seed % 4 == 0 ? best : fast;
    if (seed % 8 < 4) planner.reset();
    const PlanStatus status = planner.plan(input.field, plan, stats);
    if (status != PlanStatus::Planned) {
      ASSERT_TRUE(plan.paths.empty());
      continue;
    }
    ++planned;
    ASSERT_NE(input.kind, test::FieldKind::Invalid);
    ASSERT_GE(plan.paths.size(), 1U);
    const PlanSettings& used = planner.settings();
    const int samples = used.preset == Preset::Best ? 2 * used.fit_samples : used.samples;
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, samples, 0.140));
    const double most = kGain.gain * max_pressure(input.field) * (1.0 + 1e-6);
    for (const FocalPath& path : plan.paths) {
      for (const double p : path.pressure) ASSERT_LE(p, most);
    }
  }
  EXPECT_GT(planned, count / 4);
}

}  // namespace
}  // namespace prostm::planning
