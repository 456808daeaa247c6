#pragma once
/// The result of one call of the planner, with its arguments.

#include <optional>
#include <variant>
#include <vector>

#include "bindings.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/emit/played.hpp"
#include "prostm/plan/method.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::python {

/// The settings of a planner, which say the method too.
using AnySettings = std::variant<PlanSettings, AmSettings>;

/// The settings of a plan file. @param settings are listed as {"plan": …} or {"am": …}, and
/// outlive it.
struct SettingsInFile {
  explicit SettingsInFile(const AnySettings& settings);
  Method method;
  std::optional<Preset> preset;  ///< none for AM
  std::vector<SettingsGroup> groups;
};

struct PlanResult {
  PlanResult(py::object planned, AnySettings s)
      : target(std::move(planned)), settings(std::move(s)) {}

  /// The width and the gain that fields are rendered and scored with.
  double sigma() const;
  GainLaw gain_law() const;

  /// @throws std::invalid_argument for a patch that the target does not have.
  const TargetField& patch(int index) const;

  /// The target as a frame, of one patch where it is a TargetField.
  TargetFrame frame() const;

  /// The emission that it is taken to be played with: `given`, or the defaults. Where they give no
  /// full scale, γ times the target's largest pressure.
  EmitSettings emission(const EmitSettings* given) const;
  /// The pressures that are played. @throws as played_pressures() does.
  SegmentPressures played(const EmitSettings* given, double sample_rate) const;

  py::object target;  ///< the TargetField or TargetFrame
  AnySettings settings;
  PlanStatus status = PlanStatus::EmptyTarget;
  Plan plan;
  PlanStats stats;
  std::optional<PlanTrace> trace;
};

/// Bounds of what Eq. (1) is evaluated with, those of PlanSettings. @throws std::invalid_argument.
void check_model(double sigma, const GainLaw& gain, int patch);
/// Eq. (1) as an array of rows and columns.
py::array quasi_static_array(const Plan& plan, const TargetField& raster, double sigma,
                             const GainLaw& gain, int patch,
                             const SegmentPressures* instead = nullptr);

}  // namespace prostm::python
