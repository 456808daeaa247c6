#pragma once
/// What no plan may do, counted without looking at how it was planned.

#include "prostm/plan/plan.hpp"

namespace prostm::bench {

struct Violations {
  int plans = 0;
  int long_paths = 0;  ///< longer than L + 0.5 mm
  int crossings = 0;   ///< pairs of segments that cross, within and between paths
  int near_plans = 0;  ///< plans with two samples nearer than 0.9 σ that are on different paths or
                       ///< farther than 2σ apart along theirs, either way round
  int near_pairs = 0;  ///< those pairs
  int non_finite = 0;  ///< plans with a coordinate, pressure or length that is not finite

  void add(const Plan& plan, double sigma, double max_length);
  void add(const Violations& other);
};

}  // namespace prostm::bench
