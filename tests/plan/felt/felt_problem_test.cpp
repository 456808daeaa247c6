#include "prostm/plan/detail/fit/felt/felt_problem.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/detail/fit/felt/rise_cost.hpp"

namespace prostm {
namespace {

using namespace planning;

constexpr std::size_t kPoints = 28, kPaths = 3;

/// Irregular loops in a field of 162 mm, close to each other at some times, and their √p: all in
/// one array.
std::vector<float> uneven_loops(Random& random) {
  std::vector<float> out(3 * kPaths * kPoints);
  for (std::size_t k = 0; k < kPaths; ++k) {
    const double radius = k == 1 ? 10.0 : 20.0, x = 45.0 + 32.0 * static_cast<double>(k);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double angle =
          2.0 * kPi * (static_cast<double>(i) + random.uniform(-0.35, 0.35)) / kPoints;
      const std::size_t j = k * kPoints + i;
      out[j] = static_cast<float>(random.uniform(0.1, 1.0));
      out[kPaths * kPoints + j] = static_cast<float>(x + radius * std::cos(angle));
      out[2 * kPaths * kPoints + j] = static_cast<float>(80.0 + radius * std::sin(angle));
    }
  }
  return out;
}

/// Variables that change together, and the step in either direction.
struct Change {
  std::size_t first, count;
  float step;
};

/// Compares slopes in random directions with finite differences. @param cost of variables; writes
/// its gradient. @param share relative tolerance.
template <class Cost>
void expect_gradient(const Cost& cost, const std::vector<float>& at, const Change& change,
                     double share) {
  Random random(4);
  std::vector<float> gradient(at.size()), unused(at.size()), direction(at.size());
  cost(at, gradient);
  double apart = 0.0, whole = 0.0;
  for (int draw = 0; draw < 40; ++draw) {
    double slope = 0.0;
    for (std::size_t j = change.first; j < change.first + change.count; ++j) {
      direction[j] = static_cast<float>(random.uniform(-1.0, 1.0));
      slope += static_cast<double>(direction[j]) * static_cast<double>(gradient[j]);
    }
    const auto value = [&](float step) {
      std::vector<float> moved = at;
      for (std::size_t j = 0; j < moved.size(); ++j) moved[j] += step * direction[j];
      return static_cast<double>(cost(moved, unused));
    };
    const double difference =
        (value(change.step) - value(-change.step)) / (2.0 * static_cast<double>(change.step));
    apart += std::pow(difference - slope, 2);
    whole += difference * difference;
  }
  EXPECT_GT(whole, 0.0);
  EXPECT_LT(std::sqrt(apart / whole), share);
}

// Against a search of the nearest segment for each cell.
TEST(EnvelopeLack, SpillsWhatALoopOverSegmentsSpills) {
  constexpr double kSigma = 5.0;
  const TargetField field = fields::make(fields::Pattern::Ring, 10);
  FeltCells cells(400);
  cells.set(field, max_pressure(field));
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const std::vector<float> loops = uneven_loops(random);
    constexpr std::size_t n = kPaths * kPoints;
    const std::span<const float> all = loops, pressure = all.first(n);
    const StepPoints points{static_cast<int>(kPoints), all.subspan(n, n), all.subspan(2 * n, n)};
    EnvelopeLack envelope(400);
    envelope.set_points(cells.cells(), points, static_cast<float>(kSigma));
    double whole = 0.0, outside = 0.0;
    for (const FeltCells::Cell& cell : cells.cells()) {
      const Vec2 at(cell.x, cell.y);
      double least = 1e300, rendered = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = points.next(i);
        const Vec2 from(points.x[i], points.y[i]), to(points.x[j], points.y[j]);
        const double t =
            std::clamp((at - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
        const double square = (at - from - t * (to - from)).squaredNorm();
        if (square >= least) continue;
        least = square;
        rendered =
            ((1.0 - t) * static_cast<double>(pressure[i]) + t * static_cast<double>(pressure[j])) *
            std::exp(-0.5 * square / (kSigma * kSigma));
      }
      whole += cell.area * rendered;
      if (cell.pressure < 0.1) outside += cell.area * rendered;
    }
    ASSERT_GT(outside, 0.0);
    EXPECT_NEAR(static_cast<double>(envelope.spill(cells.cells(), pressure)), outside / whole, 1e-4)
        << seed;
  }
}

TEST(FeltProblem, HasTheGradientOfItsCost) {
  // (P10) jumps when another path becomes the nearest, so points are compared without it
  for (const double weight : {0.9, 1.0}) {
    PlanSettings settings;
    settings.paths = static_cast<int>(kPaths);
    settings.felt_weight = weight;
    settings.felt_points = true;
    FeltProblem problem(settings);
    const TargetField field = fields::make(fields::Pattern::FourPlumes, 10);
    problem.set_target(field, max_pressure(field), 4.3e-3);
    Random random(3);
    const std::vector<float> at = uneven_loops(random);
    constexpr std::size_t n = kPaths * kPoints;
    float near = 0.0F;
    const auto cost = [&](std::span<const float> v, std::span<float> gradient) {
      const StepPoints points{static_cast<int>(kPoints), v.subspan(n, n), v.subspan(2 * n, n)};
      problem.set_points(points, {0.02, {1, 2, 1}});
      const float value = problem.evaluate(v.first(n));
      problem.gradient(v.first(n), gradient.first(n));
      near = problem.slide(gradient.subspan(n, n), gradient.subspan(2 * n, n));
      return value + near;
    };
    std::vector<float> gradient(3 * n);
    cost(at, gradient);
    EXPECT_GT(near, 0.01F);
    problem.keep_loudness(std::span(at).first(n));
    expect_gradient(cost, at, {0, n, 5e-3F}, 0.005);
    // pairs are rounded, so the step must be large enough, but small enough for curvature
    if (weight == 1.0) expect_gradient(cost, at, {n, 2 * n, 4e-2F}, 0.02);
  }
}

TEST(RiseCost, HasTheGradientOfItsValues) {
  Random random(5);
  std::vector<float> at = uneven_loops(random);
  for (std::size_t j = 0; j < at.size() / 3; j += 5) at[j] = -at[j];  // an equally valid root
  constexpr std::size_t n = kPaths * kPoints;
  const PlayBounds bounds = PlayBounds::all(0.5F, 0.08F);
  for (const int pieces : {1, 2}) {
    expect_gradient(
        [&](std::span<const float> v, std::span<float> gradient) {
          std::fill(gradient.begin(), gradient.end(), 0.0F);
          return rise_cost({static_cast<int>(kPoints), v.subspan(n, n), v.subspan(2 * n, n)},
                           bounds, pieces, v.first(n), gradient.first(n), gradient.subspan(n, n),
                           gradient.subspan(2 * n, n));
        },
        at, {0, 3 * n, 2e-3F}, 0.02);
  }
}

/// A circle whose √p is `low` except at one point, where it is 1.
struct Peak {
  static constexpr std::size_t kAt = 5;
  std::vector<float> x, y, root, gradient;

  explicit Peak(float low) : root(kPoints, low), gradient(kPoints) {
    root[kAt] = 1.0F;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double angle = 2.0 * kPi * static_cast<double>(i) / kPoints;
      x.push_back(static_cast<float>(20.0 * std::cos(angle)));
      y.push_back(static_cast<float>(20.0 * std::sin(angle)));
    }
  }
  StepPoints points() const { return {static_cast<int>(kPoints), x, y}; }
  /// Whether make_playable() leaves the pressures unchanged, linear in `pieces` between points.
  bool can_be_played(const PlayBounds& bounds, int pieces) const {
    Loops loops;
    loops.reset(static_cast<int>(kPoints) * pieces, 1);
    NodeArray pressure{};
    for (int a = 0; a < loops.samples; ++a) {
      const auto i = static_cast<std::size_t>(a / pieces), j = points().next(i);
      const float t = static_cast<float>(a % pieces) / static_cast<float>(pieces), u = 1.0F - t;
      loops.set_point(a, 0, {u * x[i] + t * x[j], u * y[i] + t * y[j]});
      pressure[loops.node(a, 0)] = u * root[i] * root[i] + t * root[j] * root[j];
    }
    const NodeArray before = pressure;
    make_playable(loops, bounds, pressure);
    float most = 0.0F;
    for (int a = 0; a < loops.samples; ++a) {
      const std::size_t node = loops.node(a, 0);
      most = std::max(most, std::abs(pressure[node] - before[node]));
    }
    return most < 1e-5F;
  }
};

TEST(RiseCost, StartsWherePressuresAreNoLongerPlayable) {
  const PlayBounds bounds = PlayBounds::all(1.0F, 0.1F);
  for (const int pieces : {1, 2}) {
    int playable = 0, free = 0;
    for (float low = 0.3F; low < 0.9F; low += 0.01F) {
      Peak peak(low);
      const float cost = rise_cost(peak.points(), bounds, pieces, peak.root, peak.gradient, {}, {});
      playable += peak.can_be_played(bounds, pieces) ? 1 : 0;
      free += cost <= 0.0F ? 1 : 0;
    }
    EXPECT_GT(playable, 10) << pieces;
    EXPECT_LT(playable, 50) << pieces;
    EXPECT_NEAR(playable, free, 1) << pieces;
  }
}

}  // namespace
}  // namespace prostm
