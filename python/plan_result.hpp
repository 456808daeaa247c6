#pragma once
/// A plan with its target and settings: the result of a planner, or a recorded plan.

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/emit/played.hpp"
#include "prostm/plan/method.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::python {

/// The settings of a planner, whose type also determines the method.
using AnySettings = std::variant<PlanSettings, AmSettings>;

/// The settings of a plan file, listed as {"plan": …} or {"am": …}.
struct SettingsInFile {
  /// @param settings must outlive this object.
  explicit SettingsInFile(const AnySettings& settings);
  Method method;
  std::optional<Preset> preset;  ///< empty for AM
  std::vector<SettingsGroup> groups;
};

struct PlanResult {
  PlanResult(py::object planned, AnySettings s)
      : target(std::move(planned)), settings(std::move(s)) {}

  /// The width and the gain that a patch is rendered and scored with.
  double sigma(int patch) const;
  GainLaw gain_law() const;

  /// @throws std::invalid_argument for a patch that the target does not have.
  const TargetField& patch(int index) const;

  /// Returns the target as a frame, with one patch if it is a TargetField.
  TargetFrame frame() const;

  /// Returns the emission that plays the plan: `given`, else the recorded one, else the defaults. A
  /// full scale of 0 becomes γ times the target's largest pressure.
  EmitSettings emission(const EmitSettings* given) const;
  /// Returns the pressures that are played. @throws as played_pressures() does.
  SegmentPressures played(const EmitSettings* given, double sample_rate) const;

  py::object target;  ///< the TargetField or TargetFrame
  AnySettings settings;
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  std::optional<PlanTrace> trace;

  /// The emission of a recorded plan, and the σ of each patch when it was planned [m].
  struct Recorded {
    EmitSettings emission;
    std::array<double, kMaxPatches> sigma;
  };
  std::optional<Recorded> recorded;  ///< empty for a plan that was made here
};

/// Checks the parameters of Eq. (1) against the bounds of PlanSettings.
/// @throws std::invalid_argument.
void check_model(double sigma, const GainLaw& gain, int patch);
/// Computes Eq. (1) as an array of rows and columns.
py::array quasi_static_array(const Plan& plan, const TargetField& raster, double sigma,
                             const GainLaw& gain, int patch,
                             const SegmentPressures* instead = nullptr);

}  // namespace prostm::python
