#pragma once
/// Counts violations of the rules for all plans, independent of the planner.

#include "prostm/plan/plan.hpp"

namespace prostm::bench {

struct Violations {
  int plans = 0;
  int long_paths = 0;  ///< longer than L + 0.5 mm
  int crossings = 0;   ///< pairs of segments that cross, within and between paths
  int near_plans = 0;  ///< plans with two samples nearer than 0.9 σ, on different paths or more
                       ///< than 2σ apart along their path in both directions
  int near_pairs = 0;  ///< number of such pairs
  int non_finite = 0;  ///< plans with a coordinate, pressure or length that is not finite

  void add(const Plan& plan, double sigma, double max_length);
  void add(const Violations& other);
};

}  // namespace prostm::bench
