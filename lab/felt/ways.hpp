#pragma once
/// The ways to plan whose percepts are judged.

#include <functional>
#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// Plans for one target after the other, each from the plan before. Serves one thread.
using Planning = std::function<Plan(const TargetField&)>;

/// A way to turn targets into plans.
struct Way {
  std::string name;
  /// Starts planning; the width of the focus is measured at the place of the first target. May be
  /// called by several threads at once.
  std::function<Planning(const TargetField& first)> begin;
  bool is_control = false;  ///< a control, which must lose and is not disturbed

  /// Plans for one target alone.
  Plan plan(const TargetField& target) const { return begin(target)(target); }
};

/// Returns the plan with all its paths in step: each makes the whole number of laps in `loop` [s]
/// that changes its speed least.
Plan in_step(Plan plan, const TargetField& target, double loop);

/// Returns all ways: the first is the one that the others are compared with, `best` planned with
/// the array's width. The last are controls, which must lose.
std::vector<Way> ways(const TransducerArray& array);

}  // namespace prostm::bench
