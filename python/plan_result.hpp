#pragma once
/// What one call of the planner gave, with what it was given.

#include <optional>

#include "bindings.hpp"
#include "plan/planner.hpp"

namespace prostm::python {

struct PlanResult {
  PlanResult(py::object planned, const PlanSettings& s) : target(std::move(planned)), settings(s) {}

  /// @throws std::invalid_argument for a patch that the target does not have.
  const TargetField& patch(int index) const;

  py::object target;  ///< the TargetField or TargetFrame
  PlanSettings settings;
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  std::optional<PlanTrace> trace;
};

/// Bounds of what Eq. (1) is evaluated with, those of PlanSettings. @throws std::invalid_argument.
void check_model(double sigma, const GainLaw& gain, int patch);
/// Eq. (1) as an array of rows and columns.
py::array quasi_static_array(const Plan& plan, const TargetField& raster, double sigma,
                             const GainLaw& gain, int patch);

}  // namespace prostm::python
