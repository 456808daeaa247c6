#include <gtest/gtest.h>

#include <cmath>

#include "gradient_check.hpp"
#include "plan_checks.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/fit/descent.hpp"
#include "prostm/plan/detail/fit/fit_settings.hpp"
#include "prostm/plan/detail/fit/initial_loops.hpp"
#include "prostm/plan/detail/fit/spacing.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"
#include "random_fields.hpp"
#include "support/heap_guard.hpp"
#include "support/load.hpp"

namespace prostm::planning {
namespace {

using fields::Pattern;

constexpr std::size_t kCells = static_cast<std::size_t>(fields::kCells) * fields::kCells;

/// Loops on a pattern, and the cells to render.
struct Case {
  CellTiles cells{kCells};
  Loops loops;

  Case(Pattern pattern, int frame, int paths, int samples, std::uint64_t seed) {
    const TargetField field = fields::make(pattern, frame);
    cells.set(field, max_pressure(field), 4.0);
    InitialLoops initial(kCells);
    initial.set(cells, 0.01F);
    Random random(seed);
    StartSettings start;
    start.paths = paths;
    initial.make(start, samples, random, loops);
  }
};

TEST(CellTiles, PreserveTheMassTheAreaAndTheSkinOfTheTarget) {
  for (const Pattern pattern : fields::kPatterns) {
    const TargetField field = fields::make(pattern, 2);
    const double maximum = max_pressure(field);
    double mass = 0.0, area = 0.0;
    for (std::size_t i = 0; i < field.size(); ++i) {
      mass += field.pressure[i] / maximum;
      area += field.skin[i];
    }
    for (const double width : {2.0, 4.0, 6.0, 9.0}) {
      CellTiles cells(kCells);
      cells.set(field, maximum, width);
      double tiled_mass = 0.0, tiled_area = 0.0;
      for (const CellTile& tile : cells.tiles()) {
        for (std::size_t c = 0; c < 8; ++c) {
          tiled_area += static_cast<double>(tile.weight[c]);
          tiled_mass += static_cast<double>(tile.weight[c] * tile.pressure[c]);
          EXPECT_LE(std::hypot(tile.x[c] - tile.centre_x, tile.y[c] - tile.centre_y),
                    tile.radius + 1e-3F);
        }
      }
      EXPECT_NEAR(tiled_area, area, 1e-3 * area) << width;
      EXPECT_NEAR(tiled_mass, mass, 1e-3 * mass) << width;
    }
  }
}

/// Differences between two kernels' choices of the closest segment of a cell: of two equally close
/// ones either is correct. At a shared end both give equal pressures, but the gradient has a kink.
enum class Ties { None, AtSharedEnds, Between };

Ties ties_of(const Case& c, const ReconstructionScratch& a, const ReconstructionScratch& b) {
  const auto n = static_cast<int>(c.loops.nodes());
  Ties ties = Ties::None;
  for (std::size_t t = 0; t < c.cells.tiles().size(); ++t) {
    for (std::size_t k = 0; k < 8; ++k) {
      const int apart = (a.fits[t].segment[k] - b.fits[t].segment[k] + n) % n;
      if (c.cells.tiles()[t].weight[k] == 0.0F || apart == 0) continue;
      const bool a_follows = apart == c.loops.lanes, b_follows = apart == n - c.loops.lanes;
      const float from_end = a_follows   ? a.fits[t].along[k] + (1.0F - b.fits[t].along[k])
                             : b_follows ? b.fits[t].along[k] + (1.0F - a.fits[t].along[k])
                                         : 1.0F;
      if (from_end > 1e-4F) return Ties::Between;
      ties = Ties::AtSharedEnds;
    }
  }
  return ties;
}

/// Returns the largest difference of the pressures that two kernels render at the cells.
double largest_difference(const Case& c, const ReconstructionScratch& one_scratch,
                          const Reconstruction& one, const ReconstructionScratch& other_scratch,
                          const Reconstruction& other) {
  const auto rendered = [&](const ReconstructionScratch::TileFit& fit, const Reconstruction& at,
                            std::size_t k) {
    const auto a = static_cast<std::size_t>(fit.segment[k]);
    const std::size_t over = a + static_cast<std::size_t>(c.loops.lanes);
    const float pa = at.pressure[a],
                pb = at.pressure[over < c.loops.nodes() ? over : over - c.loops.nodes()];
    return fit.phi[k] * (pa + fit.along[k] * (pb - pa));
  };
  float largest = 0.0F;
  for (std::size_t t = 0; t < c.cells.tiles().size(); ++t) {
    for (std::size_t k = 0; k < 8; ++k) {
      if (c.cells.tiles()[t].weight[k] == 0.0F) continue;
      largest = std::max(largest, std::abs(rendered(one_scratch.fits[t], one, k) -
                                           rendered(other_scratch.fits[t], other, k)));
    }
  }
  return static_cast<double>(largest);
}

/// Returns the largest possible gradient at a node, if rendered and target pressures added
/// instead of cancelling: the scale of its rounding errors.
double largest_gradient(const Case& c, const ReconstructionScratch& scratch,
                        const Reconstruction& at) {
  const float sigma = ReconstructionSettings{}.sigma, falloff = 1.0F / (sigma * sigma);
  std::vector<float> at_node(c.loops.nodes());
  for (std::size_t t = 0; t < c.cells.tiles().size(); ++t) {
    const CellTile& cell = c.cells.tiles()[t];
    const ReconstructionScratch::TileFit& fit = scratch.fits[t];
    for (std::size_t k = 0; k < 8; ++k) {
      const auto a = static_cast<std::size_t>(fit.segment[k]);
      const float p = at.pressure[a], sum = fit.phi[k] * p + cell.pressure[k];
      at_node[a] +=
          2.0F * cell.weight[k] * sum * fit.phi[k] * p * falloff * std::hypot(fit.dx[k], fit.dy[k]);
    }
  }
  return static_cast<double>(*std::ranges::max_element(at_node));
}

TEST(Reconstruction, VectorKernelAgreesWithThePlainOne) {
  const std::uint64_t count = test::reduced(400);
  double worst = 0.0;
  std::uint64_t compared = 0, compared_gradients = 0;
  for (std::uint64_t seed = 0; seed < count; ++seed) {
    Random random(seed);
    const Pattern pattern = fields::kPatterns[seed % fields::kPatterns.size()];
    const Case c(pattern, static_cast<int>(seed % 100), 1 + static_cast<int>(seed % 8),
                 8 + random.below(30), seed);
    ReconstructionScratch plain_scratch(CellTiles::kMaxTiles), scratch(CellTiles::kMaxTiles);
    Reconstruction plain, vector;
    reconstruct_plain(c.cells, c.loops, {}, Wanted::PressuresAndGradient, plain_scratch, plain);
    fast_reconstruct()(c.cells, c.loops, {}, Wanted::PressuresAndGradient, scratch, vector);
    ASSERT_NEAR(vector.error, plain.error, 1e-5F * plain.error) << seed;
    const Ties ties = ties_of(c, plain_scratch, scratch);
    compared += ties != Ties::Between ? 1 : 0;
    compared_gradients += ties == Ties::None ? 1 : 0;
    if (ties == Ties::Between) continue;
    // compares rendered pressures; the cells may hardly determine individual pressures of the path
    EXPECT_LT(largest_difference(c, plain_scratch, plain, scratch, vector), 1e-5) << seed;
    double difference = 0.0;
    for (int k = 0; k < c.loops.paths; ++k) {
      for (int i = 0; i < c.loops.samples; ++i) {
        const std::size_t a = c.loops.node(i, k);
        const Vec2 expected(static_cast<double>(plain.gradient_x[a]),
                            static_cast<double>(plain.gradient_y[a]));
        const Vec2 got(static_cast<double>(vector.gradient_x[a]),
                       static_cast<double>(vector.gradient_y[a]));
        difference = std::max(difference, (got - expected).norm());
      }
    }
    if (ties == Ties::None)
      worst = std::max(worst, difference / largest_gradient(c, plain_scratch, plain));
  }
  EXPECT_LT(worst, 1e-5);
  EXPECT_GE(compared + count / 20 + 1, count);
  EXPECT_GT(compared_gradients, count / 2);
}

TEST(Descent, GradientAgreesWithCentralDifferences) {
  test::GradientCheck check;
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Case c(fields::kPatterns[seed % fields::kPatterns.size()], static_cast<int>(seed), 4, 20,
                 seed);
    check.add(c.cells, c.loops);
    // with bounded pressures too, (P18)
    check.add(c.cells, c.loops, PlayBounds::all(1.0F, seed % 2 == 0 ? 0.06F : 0.02F));
  }
  check.expect_agreement();
}

TEST(Descent, NeverRaisesTheCostAndKeepsToItsEvaluations) {
  constexpr std::uint64_t kSeeds = 40;
  float left = 0.0F;  // mean fraction of the cost that remains
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Case c(fields::kPatterns[seed % fields::kPatterns.size()], static_cast<int>(seed),
                 1 + static_cast<int>(seed % 8), 20, seed);
    Descent descent(CellTiles::kMaxTiles, 20, fit_settings(PlanSettings{}));
    Fit fit;
    fit.loops = c.loops;
    descent.evaluate(c.cells, fit);
    const float start = fit.cost;
    float before = start;
    for (const int evaluations : {1, 2, 7, 30}) {
      EXPECT_LE(descent.run(c.cells, fit, evaluations), evaluations);
      // pairs that were not listed before may raise the cost
      EXPECT_LE(fit.cost, before * 1.001F + 1e-3F);
      before = fit.cost;
    }
    left += fit.cost / start / kSeeds;
  }
  EXPECT_LT(left, 0.6F);
}

TEST(Descent, EndsAtItsDeadline) {
  const Case c(Pattern::Letter, 0, 4, 20, 1);
  Descent descent(CellTiles::kMaxTiles, 20, fit_settings(PlanSettings{}));
  const StageTimer timer;
  Fit fit;
  fit.loops = c.loops;
  EXPECT_EQ(descent.run(c.cells, fit, 30, {&timer, 0.0}), 1);
  EXPECT_GT(descent.run(c.cells, fit, 30, {&timer, 1e9}), 1);
}

TEST(Reconstruction, SolvedPressuresAreTheLeastSquaresSolution) {
  // changing any pressure in either direction, within its bounds, does not lower the error
  const Case c(Pattern::FourPlumes, 3, 4, 20, 5);
  ReconstructionSettings settings;
  settings.weight_coverage = 0.0F;
  ReconstructionScratch scratch(CellTiles::kMaxTiles);
  Reconstruction out;
  reconstruct_plain(c.cells, c.loops, settings, Wanted::PressuresAndGradient, scratch, out);
  const auto error = [&](const NodeArray& pressure) {
    double sum = 0.0;
    for (std::size_t t = 0; t < c.cells.tiles().size(); ++t) {
      const CellTile& tile = c.cells.tiles()[t];
      for (std::size_t k = 0; k < 8; ++k) {
        const auto& fit = scratch.fits[t];
        const auto a = static_cast<std::size_t>(fit.segment[k]);
        const std::size_t b = (a + 4) % c.loops.nodes();
        const double p =
            static_cast<double>((1.0F - fit.along[k]) * pressure[a] + fit.along[k] * pressure[b]);
        const double residual =
            static_cast<double>(fit.phi[k]) * p - static_cast<double>(tile.pressure[k]);
        sum += static_cast<double>(tile.weight[k]) * residual * residual;
      }
    }
    for (std::size_t a = 0; a < c.loops.nodes(); ++a) {
      const auto change = static_cast<double>(pressure[(a + 4) % c.loops.nodes()] - pressure[a]);
      sum += static_cast<double>(settings.smoothing) * change * change;
    }
    return sum;
  };
  const double least = error(out.pressure);
  EXPECT_NEAR(least, static_cast<double>(out.error), 1e-4 * least);
  for (std::size_t a = 0; a < c.loops.nodes(); ++a) {
    for (const float change : {-0.02F, 0.02F}) {
      NodeArray moved = out.pressure;
      moved[a] = std::min(std::max(moved[a] + change, 0.0F), settings.bounds.most[0]);
      EXPECT_GE(error(moved), least * (1.0 - 1e-5));
    }
  }
}

PlanSettings preset(const std::string& name) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(name, "preset");
  return settings;
}

SpacingRule stated_rule() {
  SpacingRule rule;
  rule.spacing = 0.9 * 8.6 - 1e-3;
  rule.along = 2.0 * 8.6 + 1e-3;
  return rule;
}

/// Returns the samples of a path in a plan: for `best` those of its search, plus one between any
/// two.
int samples_of(const PlanSettings& settings) {
  return settings.preset == Preset::Best ? 2 * settings.fit_samples : settings.samples;
}

std::vector<Vec2> all_points(const Plan& plan) {
  std::vector<Vec2> x;
  for (const FocalPath& path : plan.paths) {
    for (const Vec2& p : path.points) x.push_back(1e3 * p);
  }
  return x;
}

TEST(FitPresets, RandomFieldsGiveValidPlansThatKeepTheirSpacing) {
  constexpr int kMaxSide = 48;
  const test::Seeds seeds = test::seeds(4'000);
  Planner fast(preset("fast"), kMaxSide * kMaxSide);
  PlanSettings brief = preset("best");
  brief.fit_starts = 2;
  brief.fit_kicks = 1;
  PlanSettings quick = preset("felt");
  quick.budget = quick.traits().live_budget;
  Planner best(brief, kMaxSide * kMaxSide), felt(quick, kMaxSide * kMaxSide),
      refined(preset("felt"), kMaxSide * kMaxSide);
  std::uint64_t planned = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.end; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const test::RandomField input = test::random_field(random, kMaxSide);
    Plan plan;
    PlanStats stats;
    Planner& planner = seed % 4 == 0     ? best
                       : seed % 512 == 1 ? refined
                       : seed % 64 == 1  ? felt
                                         : fast;
    // half of them continue from a plan for another target
    if (seed % 8 < 4) planner.reset();
    const test::HeapGuard guard;
    const PlanStatus status = planner.plan(input.field, plan, stats);
    ASSERT_EQ(guard.allocations(), 0U);
    if (status != PlanStatus::Planned) {
      ASSERT_TRUE(status == PlanStatus::InvalidTarget || max_pressure(input.field) == 0.0);
      continue;
    }
    ++planned;
    ASSERT_GE(plan.paths.size(), 1U);
    const int samples = samples_of(planner.settings());
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, samples, 0.140));
    ASSERT_EQ(count_near_pairs(all_points(plan), samples, stated_rule()), 0);
    const double most = 1.4 * max_pressure(input.field) * (1.0 + 1e-6);
    for (const FocalPath& path : plan.paths) {
      for (const double p : path.pressure) ASSERT_LE(p, most);
    }
  }
  RecordProperty("planned", std::to_string(planned));
}

TEST(FitPresets, BestRendersEveryPatternBetterThanPaperValid) {
  Planner paper(preset("paper-valid"), kCells), best(preset("best"), kCells);
  double ratios = 0.0;
  for (const Pattern pattern : fields::kPatterns) {
    double theirs_rmse = 0.0, ours_rmse = 0.0, theirs_skill = 0.0, ours_skill = 0.0;
    for (const int frame : {20, 40, 60}) {
      const TargetField field = fields::make(pattern, frame);
      Plan theirs, ours;
      PlanStats stats;
      paper.plan(field, theirs, stats);
      best.reset();
      best.plan(field, ours, stats);
      const Metrics a = score_plan(field, theirs, 0, 8.6e-3, {1.4});
      const Metrics b = score_plan(field, ours, 0, 8.6e-3, {1.4});
      theirs_rmse += a.rmse;
      ours_rmse += b.rmse;
      theirs_skill += a.skill_8;
      ours_skill += b.skill_8;
    }
    EXPECT_LT(ours_rmse, theirs_rmse) << fields::to_string(pattern);
    EXPECT_GT(ours_skill, theirs_skill) << fields::to_string(pattern);
    ratios += ours_rmse / theirs_rmse;
  }
  EXPECT_LT(ratios / static_cast<double>(fields::kPatterns.size()), 0.7);
}

TEST(FitPresets, ASmallContactGetsAShortLoopThatRendersIt) {
  Planner best(preset("best"), kCells);
  TargetField field;
  field.resize(30, 30);
  field.cell = 4e-3;
  field.skin.assign(field.size(), 1);
  test::touch(field, 15, 15, 1.0);
  Plan plan;
  PlanStats stats;
  ASSERT_EQ(best.plan(field, plan, stats), PlanStatus::Planned);
  EXPECT_EQ(plan.paths.size(), 1U);
  EXPECT_LT(plan.paths[0].length, 0.05);
  EXPECT_GT(plan.paths[0].length, 0.03);
  EXPECT_GT(score_plan(field, plan, 0, 8.6e-3, {1.4}).coverage, 0.99);
}

TEST(FitPresets, AContactMuchSmallerThanABlockIsFound) {
  // averaged over its block, its pressure is below every threshold relative to the maximum
  for (const char* name : {"best", "fast"}) {
    Planner planner(preset(name), 160 * 160);
    TargetField field;
    field.resize(160, 160);
    field.cell = 0.2e-3;
    field.skin.assign(field.size(), 1);
    test::touch(field, 80, 80, 1.0);
    Plan plan;
    PlanStats stats;
    ASSERT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
    ASSERT_NO_FATAL_FAILURE(test::expect_valid_plan(plan, samples_of(preset(name)), 0.140));
    EXPECT_GT(score_plan(field, plan, 0, 8.6e-3, {1.4}).coverage, 0.99) << name;
  }
}

/// Returns a contact that spreads from one small spot over the whole field.
TargetField spreading_contact(double radius) {
  TargetField field;
  field.resize(fields::kCells, fields::kCells);
  field.cell = fields::kCell;
  field.skin.assign(field.size(), 1);
  const Vec2 spot = field.position(fields::kCells / 3, fields::kCells / 4);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const double d = (field.position(row, col) - spot).norm() / radius;
      field.pressure[field.index(row, col)] = std::exp(-0.5 * d * d);
    }
  }
  return field;
}

TEST(FitPresets, NoPathsStayBehind) {
  for (const char* name : {"fast", "best"}) {
    Planner warm(preset(name), kCells), cold(preset(name), kCells);
    double left = 0.0, anew = 0.0;
    for (int frame = 0; frame < 40; ++frame) {
      const TargetField field = spreading_contact(4e-3 * std::pow(1.07, frame));
      Plan plan;
      PlanStats stats;
      warm.plan(field, plan, stats);
      left += score_plan(field, plan, 0, 8.6e-3, {1.4}).rmse;
      cold.reset();
      cold.plan(field, plan, stats);
      anew += score_plan(field, plan, 0, 8.6e-3, {1.4}).rmse;
    }
    EXPECT_LT(left, 1.1 * anew) << name;
  }
}

TEST(FitPresets, FramesContinueFromThePreviousPaths) {
  Planner planner(preset("best"), kCells);
  TargetFrame frame;
  frame.patches.push_back(fields::make(Pattern::OnePlume, 4));
  Plan first, second;
  PlanStats stats;
  planner.plan(frame, first, stats);
  planner.plan(frame, second, stats);
  // for the same target again, the paths stay in place or improve
  const Metrics a = score_plan(frame.patches[0], first, 0, 8.6e-3, {1.4});
  const Metrics b = score_plan(frame.patches[0], second, 0, 8.6e-3, {1.4});
  EXPECT_LT(b.rmse, 1.03 * a.rmse);

  // after a reset it plans as if for the first time
  planner.reset();
  Plan again;
  planner.plan(frame, again, stats);
  ASSERT_NO_FATAL_FAILURE(test::expect_same_plan(first, again, 1.0));
}

double signed_area(const FocalPath& path) {
  double area = 0.0;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    area += 0.5 * cross(path.points[i], path.points[(i + 1) % path.points.size()]);
  }
  return area;
}

/// Returns the mean of d^−8 over the pairs of focal points and 40 ms, expressed as a distance [m].
/// @param later the start of each path, in samples after its first point.
double mean_distance(const Plan& plan, const std::array<int, kMaxPaths>& later) {
  LiftedPlan lifted;
  TargetFrame flat;
  flat.patches.emplace_back();
  flat.patches[0].resize(2, 2);
  flat.patches[0].cell = 1e-3;
  lift(plan, flat, lifted);
  double sum = 0.0, terms = 0.0;
  for (double t = 0.0; t < 0.04; t += 5e-4) {
    boost::container::static_vector<Vec3, kMaxPaths> x;
    for (std::size_t k = 0; k < plan.paths.size(); ++k) {
      const LiftedPath& path = lifted.paths[k];
      const double start = path.s[static_cast<std::size_t>(kLiftedPointsPerSegment * later[k])];
      x.push_back(point_at(path, start + path.length * t / plan.paths[k].period).p_D);
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        sum += std::pow((x[k] - x[j]).norm(), -8.0);
        terms += 1.0;
      }
    }
  }
  return std::pow(sum / terms, -1.0 / 8.0);
}

TEST(FitPresets, FocalPointsRunInOneDirectionAndStartApart) {
  Random random(1);
  for (const char* name : {"best", "fast"}) {
    Planner planner(preset(name), kCells);
    double gain = 0.0;
    int plans = 0, better = 0, draws = 0;
    for (const Pattern pattern : fields::kPatterns) {
      planner.reset();
      for (const int frame : {10, 60}) {
        Plan plan;
        PlanStats stats;
        planner.plan(fields::make(pattern, frame), plan, stats);
        for (const FocalPath& path : plan.paths) EXPECT_GT(signed_area(path), 0.0);
        if (plan.paths.size() < 2) continue;
        const double planned = mean_distance(plan, {});
        for (int draw = 0; draw < 20; ++draw) {
          std::array<int, kMaxPaths> later{};
          for (int& start : later) start = random.below(20);
          const double drawn = mean_distance(plan, later);
          gain += std::log(planned / drawn);
          better += planned > 0.97 * drawn ? 1 : 0;
          ++draws;
        }
        ++plans;
      }
    }
    ASSERT_GT(plans, 10);
    EXPECT_GT(better, draws * 95 / 100) << better << " of " << draws;
    EXPECT_GT(std::exp(gain / draws), 1.2) << name;
  }
}

/// Returns the same field on a raster with `more` additional columns without skin on the left.
TargetField widened(const TargetField& field, int more) {
  TargetField out;
  out.resize(field.rows, field.cols + more);
  out.cell = field.cell;
  out.origin = field.origin - Vec2(more * field.cell, 0.0);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t from = field.index(row, col), to = out.index(row, col + more);
      out.pressure[to] = field.pressure[from];
      out.skin[to] = field.skin[from];
      out.height[to] = field.height[from];
    }
  }
  return out;
}

TEST(FitPresets, ContinuingPathsKeepTheirFirstPoints) {
  Planner planner(preset("fast"), 2 * kCells);
  Plan before;
  int kept = 0, all = 0;
  for (int frame = 0; frame < 12; ++frame) {
    // a moving field, on rasters with varying borders
    TargetField field = fields::make(Pattern::FourPlumes, 20);
    field.origin += Vec2(1e-3 * frame, 5e-4 * frame);
    Plan plan;
    PlanStats stats;
    planner.plan(widened(field, 10 * (frame % 4)), plan, stats);
    for (const FocalPath& path : plan.paths) {
      double least = 1.0;
      for (const FocalPath& other : before.paths) {
        least = std::min(least, (path.points[0] - other.points[0]).norm());
      }
      if (frame == 0) continue;
      kept += least < 6e-3 ? 1 : 0;
      ++all;
    }
    before = plan;
  }
  EXPECT_GE(kept, all * 9 / 10) << kept << " of " << all;
}

TEST(Spacing, PushesClosePathsApart) {
  // two circles that overlap by half
  SpacingRule rule = stated_rule();
  rule.most_length.fill(140.0);
  rule.least_length = 35.0;
  std::vector<Vec2> x;
  for (const double centre : {0.0, 12.0}) {
    for (int i = 0; i < 20; ++i) {
      const double angle = 2.0 * kPi * i / 20;
      x.push_back(Vec2(centre, 0.0) + 12.0 * Vec2(std::cos(angle), std::sin(angle)));
    }
  }
  ASSERT_GT(count_near_pairs(x, 20, rule), 0);
  SpacingScratch scratch;
  const int kept = make_spaced(x, 20, rule, scratch);
  ASSERT_GE(kept, 1);
  x.resize(static_cast<std::size_t>(kept) * 20);
  EXPECT_EQ(count_near_pairs(x, 20, rule), 0);
}

}  // namespace
}  // namespace prostm::planning
