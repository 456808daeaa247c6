#pragma once
/// Plans in files: prostm-plan/1.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/plan/method.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

struct PlayedPlan;

/// The share of power of each of a plan's simultaneous focal points.
struct PowerShare {
  double array = 0.0;     ///< share of the array's power: 1 / number of paths
  double pressure = 0.0;  ///< share of full-scale pressure if all request the same, (E4a)
  double limit = 0.0;     ///< largest Σ intensity² of the emission
};

/// The quality of a plan, with all parameters of the metrics.
struct PlanQuality {
  double sigma = 0.0;                ///< of Eq. (1) [m]
  double full_scale_pressure = 0.0;  ///< full scale used for playing [unit of the target]
  Metrics played, planned;           ///< metrics as played, and with the plan's own pressures
  struct At {
    double sigma;  ///< [m]
    Metrics played;
  };
  std::vector<At> at;  ///< metrics as played, at other widths of the focal point
};

/// The content of a plan file in addition to the paths or foci.
struct PlanFileExtras {
  Method method = Method::ProStm;    ///< am: the plan has foci, which are written
  std::optional<Preset> preset;      ///< written as "preset" if given
  const PlanStats* stats = nullptr;  ///< written as "stage_us" and the counts if given
  const Metrics* metrics = nullptr;  ///< written as "metrics" if given, without their parameters
  const PlanQuality* quality = nullptr;  ///< written as "metrics" with all parameters, if given
  /// With `quality`: the level of its percept is written as "sensation", with this interval.
  std::optional<SensationInterval> sensation;
  const std::vector<Control>* controls = nullptr;
  const PowerShare* power = nullptr;                   ///< written as "power" if given
  const std::vector<std::string>* warnings = nullptr;  ///< written as "warnings" if given
  const PlayedPlan* played = nullptr;                  ///< written as "played" if given
  std::string program;  ///< version of the program, written as "prostm" if not empty
};

/// Returns speeds and periods of each path, as played and as planned.
nlohmann::ordered_json played_to_json(const PlayedPlan& played);

/// @param target the planned field; its plane and heights are included in the file. @param settings
/// the settings to include; may be empty.
std::string plan_to_json(const Plan& plan, const TargetField& target, const PlanFileExtras& extras,
                         const std::vector<SettingsGroup>& settings);

struct PlanFile {
  Method method = Method::ProStm;  ///< am if the file has foci
  Plan plan;
  TargetField raster;  ///< plane and heights (pressure 0 if the file contains none)
  /// Full scale used for playing [unit of the target]; 0 if the file has none.
  double full_scale_pressure = 0.0;
  double sigma = 0.0;  ///< σ of a focus that the plan was made for [m]; 0 if the file has none
};
/// Reads a plan. @throws InputError with a sentence.
PlanFile plan_from_json(std::string_view text, const std::string& name);

}  // namespace prostm
