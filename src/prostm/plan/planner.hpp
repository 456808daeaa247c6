#pragma once
/// The PRO-STM planner: converts a target pressure field to a few closed focal-point paths (the
/// paper's section IV; docs/design/planner.md).

#include <cstddef>
#include <memory>

#include "prostm/plan/plan.hpp"
#include "prostm/plan/plan_settings.hpp"
#include "prostm/plan/plan_stats.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Plans the paths of targets. Deterministic: the same settings and targets give bit-identical
/// plans, unless a budget is set.
class Planner {
 public:
  /// @param max_cells largest number of cells of a target passed to plan().
  /// @throws std::invalid_argument with a message that names the setting, its value and its bound.
  Planner(const PlanSettings& settings, std::size_t max_cells);
  ~Planner();
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;

  const PlanSettings& settings() const;

  /// Plans paths for one patch; `plan` is overwritten, and valid in every case. Throws nothing, and
  /// allocates only with a trace. The presets best, fast and felt continue from the previous plan,
  /// if any; call reset() first for a plan that depends on the target only.
  PlanStatus plan(const TargetField& target, Plan& plan, PlanStats& stats,
                  PlanTrace* trace = nullptr) noexcept;

  /// Plans paths for every patch of a frame. settings.paths are allocated in proportion to Σ p*
  /// (d'Hondt), at least one to each patch that has pressure (a single path goes to the strongest
  /// patch). No path spans two patches. One invalid patch makes the frame invalid. Stage times and
  /// counts are summed over patches.
  PlanStatus plan(const TargetFrame& frame, Plan& plan, PlanStats& stats) noexcept;

  /// Discards the previous plan.
  void reset() noexcept;

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace prostm
