#pragma once
/// The pressure that an array puts on the skin, in files: prostm-physical/1.

#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/score/felt.hpp"

namespace prostm {

/// All that is told of the physical field of a plan.
struct PhysicalReport {
  std::string plan, solver;  ///< the plan's file, the solver's name
  const TransducerArray* array = nullptr;
  const TargetField* raster = nullptr;
  const LoopSamples* loop = nullptr;
  std::vector<std::string> warnings;  ///< about paths that are not played as planned
  const LoopDriveResult* drives = nullptr;
  const PhysicalField* field = nullptr;
  FocusAccuracy focus;
  const Metrics* envelope_metrics = nullptr;  ///< null without a target
  const Metrics* mean_metrics = nullptr;
  const FeltField* felt = nullptr;        ///< null for loops that are not felt
  const Metrics* felt_metrics = nullptr;  ///< null without a target, too
  const Ghosts* ghosts = nullptr;         ///< the same
  std::vector<FeltHarmonic> spectrum;   ///< empty unless asked for, and for loops that are not felt
  std::vector<SettingsGroup> settings;  ///< of every stage
  std::string program;                  ///< writes "prostm", the program's version, when not empty
};
std::string physical_to_json(const PhysicalReport& report);

}  // namespace prostm
