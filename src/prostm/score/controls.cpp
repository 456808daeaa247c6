#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/am/am_pressures.hpp"
#include "prostm/core/random.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"
#include "prostm/score/detail/bands.hpp"
#include "prostm/score/detail/scorer.hpp"
#include "prostm/score/pooled.hpp"

namespace prostm {
namespace {

constexpr int kCircles = 4, kCirclePoints = 20, kDraws = 20, kPlacements = 50, kSweeps = 100;
constexpr double kWeak = 0.01;  // points below this share of the maximum are ignored

FocalPath circle(const Vec2& centre, double length, double period, double pressure) {
  FocalPath path;
  const double radius = length / (2.0 * kCirclePoints * std::sin(kPi / kCirclePoints));
  for (int i = 0; i < kCirclePoints; ++i) {
    const double angle = 2.0 * kPi * i / kCirclePoints;
    path.points.push_back(centre + radius * Vec2(std::cos(angle), std::sin(angle)));
    path.pressure.push_back(pressure);
  }
  path.length = closed_length(path);
  path.period = period;
  path.speed = path.length / period;
  return path;
}

/// Visits the skin cells with their position and p* over its maximum.
template <typename Visit>
void for_skin(const TargetField& target, double maximum, const Visit& visit) {
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t i = target.index(row, col);
      if (target.skin[i] != 0) visit(target.position(row, col), target.pressure[i] / maximum);
    }
  }
}

/// Mean p*, over its maximum, of the points that are not weak.
double mean_above_weak(const TargetField& target, double maximum) {
  double sum = 0.0, cells = 0.0;
  for_skin(target, maximum, [&](const Vec2&, double p) {
    if (p < kWeak) return;
    sum += p;
    cells += 1.0;
  });
  return sum / cells;
}

Metrics flat_field(const TargetField& target, double maximum, const Scorer& scorer) {
  double sum = 0.0, cells = 0.0;
  for_skin(target, maximum, [&](const Vec2&, double p) {
    sum += p;
    cells += 1.0;
  });
  return scorer.field(std::vector<double>(target.size(), sum / cells * maximum), 0.0);
}

/// Positions of the skin cells.
std::vector<Vec2> skin_of(const TargetField& target, double maximum) {
  std::vector<Vec2> skin;
  for_skin(target, maximum, [&](const Vec2& x, double) { skin.push_back(x); });
  return skin;
}

const Vec2& random_place(const std::vector<Vec2>& skin, Random& random) {
  return skin[static_cast<std::size_t>(random.below(static_cast<int>(skin.size())))];
}

/// Makes up to four circles that do not cross, around random skin cells.
Plan circles_on(const std::vector<Vec2>& skin, double length, double period, Random& random) {
  std::vector<Vec2> centres;
  const double apart = 1.01 * length / kPi;
  for (int k = 0; k < kCircles; ++k) {
    for (int attempt = 0; attempt < kPlacements; ++attempt) {
      const Vec2& x = random_place(skin, random);
      const bool free = std::all_of(centres.begin(), centres.end(),
                                    [&](const Vec2& c) { return (c - x).norm() > apart; });
      if (!free) continue;
      centres.push_back(x);
      break;
    }
  }
  Plan plan;
  for (const Vec2& centre : centres) plan.paths.push_back(circle(centre, length, period, 0.0));
  return plan;
}

/// Sums of one segment's cells, a and b the shares of its first and second sample in p̂ there.
constexpr std::size_t kAA = 0, kAB = 1, kBB = 2, kAP = 3, kBP = 4, kSegmentSums = 5;
constexpr std::size_t kUnknowns = static_cast<std::size_t>(kCircles) * kCirclePoints;
using NormalSums = std::array<double, kSegmentSums * kUnknowns>;

NormalSums normal_sums(const TargetField& target, double maximum, double sigma, const GainLaw& gain,
                       const std::vector<ClosestPoint>& nearest_points, const Plan& plan,
                       WorkerPool* pool) {
  const auto cols = static_cast<std::size_t>(target.cols);
  const auto band = [&](std::size_t first, std::size_t end) {
    NormalSums sums{};
    for (std::size_t cell = first * cols; cell < end * cols; ++cell) {
      if (target.skin[cell] == 0) continue;
      const double p = target.pressure[cell] / maximum;
      const ClosestPoint& nearest = nearest_points[cell];
      const double phi = std::exp(-0.5 * nearest.distance2 / (sigma * sigma)) /
                         gain.of(plan.paths[nearest.segment / kCirclePoints].period);
      const double a = (1.0 - nearest.along) * phi, b = nearest.along * phi;
      double* of_segment = sums.data() + kSegmentSums * nearest.segment;
      of_segment[kAA] += a * a;
      of_segment[kAB] += a * b;
      of_segment[kBB] += b * b;
      of_segment[kAP] += a * p;
      of_segment[kBP] += b * p;
    }
    return sums;
  };
  return sums_of_bands<kSegmentSums * kUnknowns>(pool, static_cast<std::size_t>(target.rows), band);
}

/// Sets the pressures of circles to the non-negative least-squares solution of p̂ = p* on the skin.
/// Eq. (1) is linear in the p_i: each cell depends on the two samples next to its closest point.
/// Solved by projected Gauss-Seidel on the normal equations.
void solve_pressures(const NormalSums& sums, double maximum, Plan& plan) {
  std::vector<std::array<double, kUnknowns>> normal(kUnknowns, std::array<double, kUnknowns>{});
  std::array<double, kUnknowns> right{}, solution{};
  const std::size_t count = plan.paths.size() * kCirclePoints;
  for (std::size_t i = 0; i < count; ++i) {
    const double* of_segment = sums.data() + kSegmentSums * i;
    const std::size_t j = (i + 1) % kCirclePoints == 0 ? i + 1 - kCirclePoints : i + 1;
    normal[i][i] += of_segment[kAA];
    normal[j][j] += of_segment[kBB];
    normal[i][j] += of_segment[kAB];
    normal[j][i] += of_segment[kAB];
    right[i] += of_segment[kAP];
    right[j] += of_segment[kBP];
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t i = 0; i < count; ++i) {
      // samples with hardly any effect on the skin stay at 0
      if (normal[i][i] < 1e-9) continue;
      double residual = right[i];
      for (std::size_t j = 0; j < count; ++j) residual -= normal[i][j] * solution[j];
      solution[i] = std::max(solution[i] + residual / normal[i][i], 0.0);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    plan.paths[i / kCirclePoints].pressure[i % kCirclePoints] = solution[i] * maximum;
  }
}

/// Returns the present pressures of a plan's paths, for closest points computed before they
/// changed.
SegmentPressures own_pressures(const Plan& plan) {
  SegmentPressures out;
  for (const FocalPath& path : plan.paths) {
    for (std::size_t i = 0; i < path.pressure.size(); ++i) {
      out.pressure.push_back(path.pressure[i]);
      out.pressure.push_back(path.pressure[(i + 1) % path.pressure.size()]);
      out.end.push_back(out.pressure.size());
    }
  }
  return out;
}

/// Random circles with their solved pressures, and the closest point of each cell.
struct SolvedCircles {
  Plan plan;
  std::vector<ClosestPoint> nearest;
};

SolvedCircles solved_circles(const TargetField& target, double sigma, const GainLaw& gain,
                             double length, Random& random, WorkerPool* pool) {
  const double maximum = max_pressure(target);
  SolvedCircles out = {circles_on(skin_of(target, maximum), length, 1.0 / gain.draw_rate, random),
                       {}};
  out.nearest = closest_points(target, out.plan, 0, pool);
  solve_pressures(normal_sums(target, maximum, sigma, gain, out.nearest, out.plan, pool), maximum,
                  out.plan);
  return out;
}

Vec2 centre_of_mass(const TargetField& target, double maximum) {
  Vec2 sum = Vec2::Zero();
  double mass = 0.0;
  for_skin(target, maximum, [&](const Vec2& x, double p) {
    sum += p * x;
    mass += p;
  });
  return sum / mass;
}

/// Moves the plan so that its mean sample or focus lies at `centre`, and scales its highest
/// effective pressure to `maximum`.
Plan moved(const Plan& other, const Vec2& centre, double maximum, const GainLaw& gain) {
  Vec2 mean = Vec2::Zero();
  double samples = 0.0, highest = 0.0;
  const auto count = [&](const Vec2& x, double effective) {
    mean += x;
    samples += 1.0;
    highest = std::max(highest, effective);
  };
  for (const FocalPath& path : other.paths) {
    // converts the path's pressures to the γ of the longest path
    const double weight = gain.gain / gain.of(path.period);
    for (std::size_t i = 0; i < path.points.size(); ++i)
      count(path.points[i], path.pressure[i] * weight);
  }
  for (const FocalPoint& focus : other.foci) count(focus.position, focus.pressure);

  Plan plan = other;
  translate(plan, centre - mean / samples);
  for (FocalPath& path : plan.paths) {
    path.patch = 0;
    for (double& p : path.pressure) p = highest > 0.0 ? p / highest * gain.gain * maximum : 0.0;
  }
  for (FocalPoint& focus : plan.foci) {
    focus.patch = 0;
    focus.pressure = highest > 0.0 ? focus.pressure / highest * maximum : 0.0;
  }
  return plan;
}

/// Returns foci at random skin cells, with the pressures of AM.
Plan random_foci(const TargetField& target, const std::vector<Vec2>& skin, std::size_t count,
                 double sigma, Random& random) {
  Plan plan;
  for (std::size_t k = 0; k < count; ++k) plan.foci.push_back({0, random_place(skin, random), 0.0});
  set_pressures(target, sigma, plan.foci);
  return plan;
}

}  // namespace

Plan circles_at_mass_centres(const TargetField& target, const GainLaw& gain, double length,
                             std::uint64_t seed) {
  Plan plan;
  const double maximum = max_pressure(target);
  if (!(maximum > 0.0)) return plan;
  planning::WeightedKMeans kmeans(target.size());
  for_skin(target, maximum, [&](const Vec2& x, double p) {
    if (p >= kWeak) kmeans.add(x, p);
  });
  planning::Clusters clusters;
  kmeans.run(kCircles, 100, seed, clusters);
  const double period = 1.0 / gain.draw_rate,
               pressure = gain.of(period) * mean_above_weak(target, maximum) * maximum;
  for (const Vec2& centre : clusters.centre)
    plan.paths.push_back(circle(centre, length, period, pressure));
  return plan;
}

Plan circle_at_mean_distance(const TargetField& target, const GainLaw& gain, double least_length,
                             double most_length) {
  const double maximum = max_pressure(target);
  if (!(maximum > 0.0)) return {};
  const Vec2 centre = centre_of_mass(target, maximum);
  double moment = 0.0, mass = 0.0;
  for_skin(target, maximum, [&](const Vec2& x, double p) {
    moment += p * (x - centre).norm();
    mass += p;
  });
  const double length = std::clamp(2.0 * kPi * moment / mass, least_length, most_length);
  const double period = 1.0 / gain.draw_rate;
  Plan plan;
  plan.paths.push_back(
      circle(centre, length, period, gain.of(period) * mean_above_weak(target, maximum) * maximum));
  return plan;
}

Plan random_circles(const TargetField& target, double sigma, const GainLaw& gain, double length,
                    Random& random) {
  if (!(max_pressure(target) > 0.0)) return {};
  return solved_circles(target, sigma, gain, length, random, nullptr).plan;
}

namespace {

std::vector<Control> controls_by(WorkerPool* pool, const TargetField& target, double sigma,
                                 const GainLaw& gain, double length, const Plan* other,
                                 std::uint64_t seed,
                                 const std::function<void(int done, int all)>& progress) {
  const double maximum = max_pressure(target);
  if (!(maximum > 0.0)) return {};
  const Scorer scorer(target, pool);
  const bool others = other != nullptr && !other->empty();
  const bool stands_still = others && !other->foci.empty();
  const int all = 2 + kDraws + (stands_still ? kDraws : 0) + (others ? 1 : 0);
  int done = 0;
  const auto scored = [&](const Metrics& metrics) {
    if (progress) progress(++done, all);
    return metrics;
  };
  const auto score = [&](const Plan& plan) { return scored(scorer.plan(plan, 0, sigma, gain)); };
  std::vector<Control> table;
  table.push_back({"flat field", flat_field(target, maximum, scorer)});
  ++done;
  const Plan circles = circles_at_mass_centres(target, gain, length, seed);
  table.push_back({"four circles at the mass centres", score(circles)});

  const std::vector<Vec2> skin = skin_of(target, maximum);
  Random random(seed);
  std::vector<Metrics> draws;
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto [plan, nearest] = solved_circles(target, sigma, gain, length, random, pool);
    const SegmentPressures solved = own_pressures(plan);
    draws.push_back(scored(scorer.plan(plan, 0, sigma, gain, nearest, &solved)));
  }
  table.push_back({"random circles, solved pressures", median(draws)});

  if (!others) return table;
  if (stands_still) {
    draws.clear();
    for (int draw = 0; draw < kDraws; ++draw)
      draws.push_back(score(random_foci(target, skin, other->foci.size(), sigma, random)));
    table.push_back({"random foci, solved pressures", median(draws)});
  }
  table.push_back({stands_still ? "foci of another target" : "paths of another target",
                   score(moved(*other, centre_of_mass(target, maximum), maximum, gain))});
  return table;
}

}  // namespace

std::vector<Control> controls(const TargetField& target, double sigma, const GainLaw& gain,
                              double length, const Plan* other, std::uint64_t seed,
                              const std::function<void(int done, int all)>& progress) {
  return controls_by(nullptr, target, sigma, gain, length, other, seed, progress);
}

std::vector<Control> controls(const TargetField& target, double sigma, const GainLaw& gain,
                              double length, const Plan* other, std::uint64_t seed,
                              const std::function<void(int done, int all)>& progress,
                              WorkerPool& pool) {
  return controls_by(&pool, target, sigma, gain, length, other, seed, progress);
}

}  // namespace prostm
