#pragma once
/// Plans in files: prostm-plan/1.

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/plan/method.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

struct PlayedPlan;

/// The share of power of each focal point of a plan, all drawn at the same time.
struct PowerShare {
  double array = 0.0;     ///< of the array's power: 1 / number of paths
  double pressure = 0.0;  ///< of full scale's radiation pressure, when all want the same, (E4a)
  double limit = 0.0;     ///< largest Σ intensity² that the emission allows
};

/// How good a plan is, with all that the numbers depend on.
struct PlanQuality {
  double sigma = 0.0;                ///< of Eq. (1) [m]
  double full_scale_pressure = 0.0;  ///< that it is played with [unit of the target]
  Metrics played, planned;           ///< of what is played, and with the plan's own pressures
  struct At {
    double sigma;  ///< [m]
    Metrics played;
  };
  std::vector<At> at;  ///< what is played at other widths of the focal point
};

/// The content of a plan file besides the paths or foci.
struct PlanFileExtras {
  Method method = Method::ProStm;    ///< am: the plan holds foci, and they are written
  std::optional<Preset> preset;      ///< writes "preset", when given
  const PlanStats* stats = nullptr;  ///< writes "stage_us" and the counts, when given
  const Metrics* metrics = nullptr;  ///< writes "metrics", when given, and nothing on what they are
  const PlanQuality* quality = nullptr;  ///< writes "metrics" and all that they depend on
  const std::vector<Control>* controls = nullptr;
  const PowerShare* power = nullptr;                   ///< writes "power", when given
  const std::vector<std::string>* warnings = nullptr;  ///< writes "warnings", when given
  const PlayedPlan* played = nullptr;                  ///< writes "played", when given
  std::string program;  ///< writes "prostm", the program's version, when not empty
};

/// Speeds and periods of each path as played and as planned, for files.
nlohmann::ordered_json played_to_json(const PlayedPlan& played);

/// @param target the field that was planned: its plane and heights are repeated in the file.
/// @param settings empty: none are written.
std::string plan_to_json(const Plan& plan, const TargetField& target, const PlanFileExtras& extras,
                         const std::vector<SettingsGroup>& settings);

struct PlanFile {
  Method method = Method::ProStm;  ///< am where the file has foci
  Plan plan;
  TargetField raster;  ///< plane and heights (pressure 0 where the file repeats none)
  /// That the plan is played with [unit of the target]; 0 where the file has none.
  double full_scale_pressure = 0.0;
};
/// @throws InputError with a sentence.
PlanFile plan_from_json(std::string_view text, const std::string& name);

}  // namespace prostm
