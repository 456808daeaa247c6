#pragma once
/// Checks for valid plans that do not use the planner's own geometry.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prostm/plan/planner.hpp"

namespace prostm::test {

/// Returns the plan of a new planner.
inline Plan plan_of(const PlanSettings& settings, const TargetField& field) {
  Planner planner(settings, field.size());
  Plan plan;
  PlanStats stats;
  EXPECT_EQ(planner.plan(field, plan, stats), PlanStatus::Planned);
  return plan;
}

inline double distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const double length2 = (b - a).squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
  return (a + t * (b - a) - p).norm();
}

/// Returns whether two segments cross or come within half a micrometre of each other.
inline bool touch(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto side = [](const Vec2& o, const Vec2& e, const Vec2& p) { return cross(e - o, p - o); };
  if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
  return std::min({distance_to_segment(a, c, d), distance_to_segment(b, c, d),
                   distance_to_segment(c, a, b), distance_to_segment(d, a, b)}) < 0.5e-6;
}

/// Counts pairs of segments that touch, over all paths, excluding neighbours on a path.
inline int touching_pairs(const Plan& plan) {
  int count = 0;
  for (std::size_t k = 0; k < plan.paths.size(); ++k) {
    for (std::size_t m = k; m < plan.paths.size(); ++m) {
      const auto &p = plan.paths[k].points, &q = plan.paths[m].points;
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = m == k ? i + 2 : 0; j < q.size(); ++j) {
          if (m == k && i == 0 && j + 1 == p.size()) continue;
          count += touch(p[i], p[(i + 1) % p.size()], q[j], q[(j + 1) % q.size()]) ? 1 : 0;
        }
      }
    }
  }
  return count;
}

/// Checks for finite points, finite non-negative pressures, and the stated length, speed and
/// period.
inline void expect_finite_plan(const Plan& plan, int samples) {
  for (const FocalPath& path : plan.paths) {
    ASSERT_EQ(path.points.size(), static_cast<std::size_t>(samples));
    ASSERT_EQ(path.pressure.size(), path.points.size());
    for (const Vec2& x : path.points) ASSERT_TRUE(std::isfinite(x.x()) && std::isfinite(x.y()));
    for (const double p : path.pressure) ASSERT_TRUE(std::isfinite(p) && p >= 0.0) << p;
    ASSERT_GT(path.length, 0.0);
    ASSERT_DOUBLE_EQ(path.length, closed_length(path));
    // the period follows from the length on the skin, which is flat here and summed otherwise
    ASSERT_NEAR(path.period * path.speed, path.length, 1e-12 * path.length);
  }
}

/// Checks for closed paths of at most L with distinct points, which cross neither themselves nor
/// others.
inline void expect_valid_plan(const Plan& plan, int samples, double max_length) {
  ASSERT_NO_FATAL_FAILURE(expect_finite_plan(plan, samples));
  for (const FocalPath& path : plan.paths) {
    ASSERT_LE(path.length, max_length + 1e-9);
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j)
        ASSERT_GT((path.points[i] - path.points[j]).norm(), 0.5e-6);
    }
  }
  ASSERT_EQ(touching_pairs(plan), 0);
}

/// Checks two plans for bitwise equality; the second one's pressures are `scale` times the first
/// one's.
inline void expect_same_plan(const Plan& a, const Plan& b, double scale) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t k = 0; k < a.paths.size(); ++k) {
    ASSERT_EQ(a.paths[k].patch, b.paths[k].patch);
    ASSERT_EQ(a.paths[k].length, b.paths[k].length);
    ASSERT_EQ(a.paths[k].points.size(), b.paths[k].points.size());
    for (std::size_t i = 0; i < a.paths[k].points.size(); ++i) {
      ASSERT_EQ(a.paths[k].points[i], b.paths[k].points[i]);
      ASSERT_EQ(scale * a.paths[k].pressure[i], b.paths[k].pressure[i]);
    }
  }
}

/// Checks that points of two plans agree within 1e-9 m, and pressures within 1e-9 after dividing
/// the second one's by `scale`.
inline void expect_scaled_plan(const Plan& a, const Plan& b, double scale) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t k = 0; k < a.paths.size(); ++k) {
    const FocalPath &p = a.paths[k], &q = b.paths[k];
    ASSERT_EQ(p.patch, q.patch);
    ASSERT_EQ(p.points.size(), q.points.size());
    const double most = *std::max_element(p.pressure.begin(), p.pressure.end());
    for (std::size_t i = 0; i < p.points.size(); ++i) {
      ASSERT_LE((p.points[i] - q.points[i]).norm(), 1e-9);
      ASSERT_NEAR(p.pressure[i], q.pressure[i] / scale, 1e-9 * most);
    }
  }
}

}  // namespace prostm::test
