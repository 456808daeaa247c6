#include "prostm/plan/detail/fit/playable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plan_checks.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"
#include "random_fields.hpp"
#include "support/load.hpp"

namespace prostm {
namespace {

using namespace planning;

/// Irregular loops with equations like those of nearby cells, and steep right-hand sides.
struct Problem {
  Loops loops;
  PressureEquations equations;
  PlayBounds bounds;
  NodeArray pressure;

  explicit Problem(std::uint64_t seed) {
    Random random(seed);
    loops.reset(8 + random.below(57), 1 + random.below(8));
    bounds = PlayBounds::all(static_cast<float>(random.uniform(0.3, 1.0)),
                             static_cast<float>(random.uniform(0.02, 0.5)),
                             static_cast<float>(random.below(2)) * 0.01F);
    equations.diagonal.fill(0.02F);
    equations.after.fill(0.0F);
    equations.right.fill(0.0F);
    for (int k = 0; k < loops.paths; ++k) fill(k, random);
    for (std::size_t a = 0; a < loops.nodes(); ++a) {
      pressure[a] = std::clamp(equations.right[a] / equations.diagonal[a], 0.0F, bounds.most[0]);
    }
  }
  void fill(int k, Random& random) {
    const double radius = random.uniform(5.0, 22.0), peak = random.uniform(0.0, loops.samples),
                 width = random.uniform(0.5, 0.3 * loops.samples);
    for (int i = 0; i < loops.samples; ++i) {
      const double angle = 2.0 * kPi * (i + random.uniform(-0.3, 0.3)) / loops.samples;
      loops.set_point(i, k, radius * Vec2(std::cos(angle), std::sin(angle)));
      const std::size_t a = loops.node(i, k);
      const double diagonal = random.uniform(1.0, 20.0);
      equations.diagonal[a] = static_cast<float>(diagonal);
      equations.after[a] = static_cast<float>(random.uniform(0.0, 0.4));
      const double away = std::remainder(i - peak, loops.samples) / width;
      const double wanted = std::exp(-0.5 * away * away) + random.uniform(-0.2, 0.2);
      equations.right[a] = static_cast<float>(diagonal * wanted);
    }
  }
  std::size_t next(std::size_t a) const {
    const std::size_t b = a + static_cast<std::size_t>(loops.lanes);
    return b < loops.nodes() ? b : b - loops.nodes();
  }
  double step(std::size_t a) const {
    const std::size_t b = next(a);
    return static_cast<double>(bounds.slope[0]) *
           std::hypot(static_cast<double>(loops.x[b] - loops.x[a]),
                      static_cast<double>(loops.y[b] - loops.y[a]));
  }
  /// Returns the quadratic form of the equations at pressures p.
  double form(const std::vector<double>& p) const {
    double sum = 0.0;
    for (std::size_t a = 0; a < loops.nodes(); ++a) {
      sum += p[a] * (static_cast<double>(equations.diagonal[a]) * p[a] +
                     2.0 * static_cast<double>(equations.after[a]) * p[next(a)] -
                     2.0 * static_cast<double>(equations.right[a]));
    }
    return sum;
  }
  double form(const NodeArray& p) const {
    return form(
        std::vector<double>(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(loops.nodes())));
  }
};

void expect_playable(const Problem& problem, std::uint64_t seed) {
  for (std::size_t a = 0; a < problem.loops.nodes(); ++a) {
    const auto p = static_cast<double>(problem.pressure[a]),
               q = static_cast<double>(problem.pressure[problem.next(a)]);
    ASSERT_TRUE(p >= 0.0 && p <= static_cast<double>(problem.bounds.most[0]) * (1.0 + 1e-6))
        << "seed " << seed << ": " << p;
    ASSERT_LE(std::abs(std::sqrt(p) - std::sqrt(q)), problem.step(a) * (1.0 + 1e-5) + 1e-6)
        << "seed " << seed << ", node " << a;
    // p is linear between nodes, so its root is steepest next to the lower one
    ASSERT_LE(std::sqrt(0.5 * (p + q)) - std::sqrt(std::min(p, q)),
              0.5 * problem.step(a) * (1.0 + 1e-5) + 1e-6)
        << "seed " << seed << ", half way after node " << a;
  }
}

TEST(Playable, SoftenedPressuresAreNeverTooSteep) {
  const test::Seeds seeds = test::seeds(20'000);
  for (std::uint64_t seed = seeds.first; seed < seeds.end; ++seed) {
    Problem problem(seed);
    if (seed % 2 == 0) soften(problem.loops, problem.bounds, problem.equations, problem.pressure);
    make_playable(problem.loops, problem.bounds, problem.pressure);
    ASSERT_NO_FATAL_FAILURE(expect_playable(problem, seed));
  }
}

/// Takes thousands of projected gradient steps: each on the form, then to the middle between the
/// largest root below and the smallest root above that are not too steep, found by a walk from
/// every node of a path in both directions. @return the smallest form of all.
double slow_least(const Problem& problem) {
  const Loops& loops = problem.loops;
  const auto n = static_cast<std::size_t>(loops.samples),
             lanes = static_cast<std::size_t>(loops.lanes);
  std::vector<double> p(loops.nodes(), 0.0), u(loops.nodes(), 0.0);
  const auto project = [&](std::size_t k) {
    std::vector<double> low(n), high(n), step(n);
    for (std::size_t i = 0; i < n; ++i) {
      low[i] = high[i] = u[i * lanes + k];
      step[i] = problem.step(i * lanes + k);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (const bool ahead : {true, false}) {
        double most = u[i * lanes + k], least = most;
        for (std::size_t m = 0, at = i; m < n; ++m) {
          const std::size_t to = ahead ? (at + 1) % n : (at + n - 1) % n;
          const double s = step[ahead ? at : to];
          most = std::sqrt(most * most + 2.0 * most * s + 0.5 * s * s);
          least = std::max(0.0, std::sqrt(least * least + 0.5 * s * s) - s);
          low[to] = std::min(low[to], most);
          high[to] = std::max(high[to], least);
          at = to;
        }
      }
    }
    for (std::size_t i = 0; i < n; ++i) u[i * lanes + k] = 0.5 * (low[i] + high[i]);
  };
  double least = 0.0;  // the form at zero pressure
  for (int step = 0; step < 4000; ++step) {
    const double rate = 0.02 / (1.0 + step / 400);
    for (std::size_t a = 0; a < p.size(); ++a) {
      const std::size_t before = a >= lanes ? a - lanes : a + p.size() - lanes;
      const double pull = static_cast<double>(problem.equations.diagonal[a]) * p[a] +
                          static_cast<double>(problem.equations.after[a]) * p[problem.next(a)] +
                          static_cast<double>(problem.equations.after[before]) * p[before] -
                          static_cast<double>(problem.equations.right[a]);
      u[a] = std::sqrt(
          std::clamp(p[a] - rate * pull, 0.0, static_cast<double>(problem.bounds.most[0])));
    }
    for (int k = 0; k < loops.paths; ++k) project(static_cast<std::size_t>(k));
    for (std::size_t a = 0; a < p.size(); ++a) p[a] = u[a] * u[a];
    least = std::min(least, problem.form(p));
  }
  return least;
}

TEST(Playable, SoftenedPressuresAreNearlyThePlayableOptimum) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    Problem problem(seed);
    if (problem.loops.paths > 2 || problem.loops.samples > 40) continue;
    problem.bounds.least.fill(0.0F);
    const double slow = slow_least(problem);
    soften(problem.loops, problem.bounds, problem.equations, problem.pressure);
    make_playable(problem.loops, problem.bounds, problem.pressure);
    // both are negative: the gain over zero pressure
    EXPECT_LE(problem.form(problem.pressure), 0.99 * slow) << seed;
  }
}

PlanSettings preset(const std::string& name) {
  PlanSettings settings;
  settings.preset = from_name<Preset>(name, "preset");
  return settings;
}

/// Checks the limits of the emission for a plan, as stated in (P18).
void expect_playable(const Plan& plan, double full_scale) {
  for (const FocalPath& path : plan.paths) {
    const std::size_t n = path.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      const double rise = std::abs(std::sqrt(path.pressure[i]) - std::sqrt(path.pressure[j])) /
                          std::sqrt(full_scale);
      const double way = (path.points[j] - path.points[i]).norm();
      ASSERT_LE(rise, way / (path.speed * 1e-3) * (1.0 + 1e-4) + 1e-5);
      ASSERT_LE(path.pressure[i], full_scale * (1.0 + 1e-5));
    }
  }
}

TEST(Playable, PlansOfRandomFieldsArePlayableAtAnyFullScale) {
  constexpr int kMaxSide = 40;
  const test::Seeds seeds = test::seeds(1'500);
  for (const double full_scale : {0.0, 0.4, 30.0}) {
    PlanSettings fast = preset("fast"), best = preset("best");
    fast.full_scale_pressure = best.full_scale_pressure = full_scale;
    best.fit_starts = best.fit_kicks = 1;
    Planner planners[] = {Planner(fast, kMaxSide * kMaxSide), Planner(best, kMaxSide * kMaxSide)};
    for (std::uint64_t seed = seeds.first; seed < seeds.end; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      const test::RandomField input = test::random_field(random, kMaxSide);
      Planner& planner = planners[seed % 8 == 0 ? 1 : 0];
      if (seed % 3 == 0) planner.reset();
      Plan plan;
      PlanStats stats;
      if (planner.plan(input.field, plan, stats) != PlanStatus::Planned) continue;
      ASSERT_NO_FATAL_FAILURE(
          expect_playable(plan, full_scale > 0.0 ? full_scale : 1.4 * max_pressure(input.field)));
    }
  }
}

TargetField contact(double width) {
  TargetField field;
  field.resize(fields::kCells, fields::kCells);
  field.cell = fields::kCell;
  field.skin.assign(field.size(), 1);
  const Vec2 middle = field.position(fields::kCells / 3, fields::kCells / 2);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const double d = (field.position(row, col) - middle).norm() / width;
      field.pressure[field.index(row, col)] = std::exp(-0.5 * d * d);
    }
  }
  return field;
}

/// Computes a focal point's positions and pressures in the second lap of a path as emitted: the
/// intensity follows √(p / full scale), by at most 1/40 per sample at 40 kHz.
void second_lap(const FocalPath& path, double full_scale, std::vector<Vec2>& places,
                std::vector<double>& played) {
  const std::size_t n = path.points.size();
  const int samples = static_cast<int>(std::ceil(path.length / path.speed * 40e3 - 1e-6));
  double intensity = 0.0;
  for (int k = 0; k < 2 * samples; ++k) {
    double left = path.length * (k % samples) / samples;
    std::size_t i = 0;
    double edge = (path.points[1] - path.points[0]).norm();
    for (; left > edge && i + 1 < n; edge = (path.points[(i + 1) % n] - path.points[i]).norm()) {
      left -= edge;
      ++i;
    }
    const double t = std::min(left / edge, 1.0);
    const std::size_t j = (i + 1) % n;
    const double wanted = (1.0 - t) * path.pressure[i] + t * path.pressure[j];
    bool saturated = false;
    const double goal = drive_intensity(wanted, full_scale, 0.01, saturated);
    intensity += std::clamp(goal - intensity, -1.0 / 40.0, 1.0 / 40.0);
    if (k < samples) continue;
    places.push_back((1.0 - t) * path.points[i] + t * path.points[j]);
    played.push_back(full_scale * intensity * intensity);
  }
}

/// Returns the RMSE of Eq. (1) with the played pressures.
double played_rmse(const TargetField& field, const Plan& plan) {
  const double maximum = max_pressure(field), gain = 1.4, sigma = 8.6e-3;
  std::vector<Vec2> places;
  std::vector<double> played;
  for (const FocalPath& path : plan.paths) second_lap(path, gain * maximum, places, played);
  double sum = 0.0;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const Vec2 x = field.position(row, col);
      double least = 1e9, pressure = 0.0;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const double distance2 = (places[k] - x).squaredNorm();
        if (distance2 >= least) continue;
        least = distance2;
        pressure = played[k];
      }
      const double felt = pressure / gain * std::exp(-0.5 * least / (sigma * sigma));
      const double error = (felt - field.pressure[field.index(row, col)]) / maximum;
      sum += error * error;
    }
  }
  return std::sqrt(sum / static_cast<double>(field.size()));
}

double planned_rmse(const TargetField& field, const Plan& plan) {
  return score_plan(field, plan, 0, 8.6e-3, {1.4}).rmse;
}

TEST(Playable, ASmallContactIsPlayedAsPlanned) {
  for (const double width : {2e-3, 3e-3, 4e-3, 7e-3}) {
    SCOPED_TRACE(width);
    const TargetField field = contact(width);
    const double theirs = played_rmse(field, test::plan_of(preset("paper-valid"), field));
    for (const char* name : {"best", "fast"}) {
      const Plan plan = test::plan_of(preset(name), field);
      const double planned = planned_rmse(field, plan), played = played_rmse(field, plan);
      EXPECT_TRUE(played < 1.1 * planned || played < planned + 0.003)
          << name << ": planned " << planned << ", played " << played;
      EXPECT_LT(played, theirs) << name;
    }
  }
}

TEST(Playable, NoPathIsSilent) {
  for (const double width : {2e-3, 4e-3, 8e-3}) {
    for (const char* name : {"best", "fast"}) {
      const TargetField field = contact(width);
      for (const FocalPath& path : test::plan_of(preset(name), field).paths) {
        EXPECT_GE(*std::max_element(path.pressure.begin(), path.pressure.end()),
                  0.01 * 1.4 * max_pressure(field))
            << name << ", " << width;
      }
    }
  }
}

TEST(Playable, ASmallContactGetsNoSuperfluousPaths) {
  // one lap of 140 mm circles the whole contact more than once
  EXPECT_LE(test::plan_of(preset("best"), contact(2e-3)).paths.size(), 2U);
  EXPECT_LE(test::plan_of(preset("best"), contact(3e-3)).paths.size(), 2U);
}

}  // namespace
}  // namespace prostm
