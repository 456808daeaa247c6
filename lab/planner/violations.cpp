#include "planner/violations.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/plan/detail/validity.hpp"

namespace prostm::bench {
namespace {

bool is_finite(const FocalPath& path) {
  const auto finite = [](double v) { return std::isfinite(v); };
  return finite(path.length) &&
         std::all_of(path.points.begin(), path.points.end(),
                     [&](const Vec2& x) { return finite(x.x()) && finite(x.y()); }) &&
         std::all_of(path.pressure.begin(), path.pressure.end(), finite);
}

std::vector<Vec2> in_mm(const FocalPath& path) {
  std::vector<Vec2> points;
  for (const Vec2& x : path.points) points.push_back(1e3 * x);
  return points;
}

/// Returns the arc length from the first point to each point [m].
std::vector<double> arc_lengths(const FocalPath& path) {
  std::vector<double> at(path.points.size(), 0.0);
  for (std::size_t i = 1; i < at.size(); ++i) {
    at[i] = at[i - 1] + (path.points[i] - path.points[i - 1]).norm();
  }
  return at;
}

int near_pairs_of(const Plan& plan, double sigma) {
  int count = 0;
  for (std::size_t k = 0; k < plan.paths.size(); ++k) {
    const FocalPath& a = plan.paths[k];
    const std::vector<double> at = arc_lengths(a);
    for (std::size_t m = k; m < plan.paths.size(); ++m) {
      const FocalPath& b = plan.paths[m];
      for (std::size_t i = 0; i < a.points.size(); ++i) {
        for (std::size_t j = m == k ? i + 1 : 0; j < b.points.size(); ++j) {
          if ((a.points[i] - b.points[j]).norm() >= 0.9 * sigma) continue;
          const double along = m == k ? at[j] - at[i] : HUGE_VAL;
          if (m != k || std::min(along, a.length - along) > 2.0 * sigma) ++count;
        }
      }
    }
  }
  return count;
}

}  // namespace

void Violations::add(const Plan& plan, double sigma, double max_length) {
  constexpr double kTolerance = 0.5e-3;  // [m]
  ++plans;
  if (!std::all_of(plan.paths.begin(), plan.paths.end(), is_finite)) {
    ++non_finite;
    return;
  }
  std::vector<std::vector<Vec2>> loops;
  for (const FocalPath& path : plan.paths) {
    if (closed_length(path) > max_length + kTolerance) ++long_paths;
    loops.push_back(in_mm(path));
    crossings += planning::count_self_crossings(loops.back());
    for (std::size_t k = 0; k + 1 < loops.size(); ++k) {
      crossings += planning::count_crossings(loops[k], loops.back());
    }
  }
  const int near = near_pairs_of(plan, sigma);
  near_pairs += near;
  near_plans += near > 0 ? 1 : 0;
}

void Violations::add(const Violations& other) {
  plans += other.plans;
  long_paths += other.long_paths;
  crossings += other.crossings;
  near_plans += other.near_plans;
  near_pairs += other.near_pairs;
  non_finite += other.non_finite;
}

}  // namespace prostm::bench
