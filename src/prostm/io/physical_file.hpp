#pragma once
/// The pressure of an array on the skin, in files: prostm-physical/1.

#include <string>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/score/felt.hpp"

namespace prostm {

/// The content of a file about the physical field of a plan.
struct PhysicalReport {
  std::string plan, solver;  ///< the plan's file, the solver's name
  const TransducerArray* array = nullptr;
  const TargetField* raster = nullptr;
  const LoopSamples* loop = nullptr;
  std::vector<std::string> warnings;  ///< warnings about paths that are not played as planned
  const LoopDriveResult* drives = nullptr;
  const PhysicalField* field = nullptr;
  FocusAccuracy focus;
  /// Shape and spill by Eq. (1), felt shape, and felt strength, as in a plan's file; null without a
  /// target.
  const Metrics* quality = nullptr;
  const Metrics* envelope_metrics = nullptr;  ///< null without a target
  const Metrics* mean_metrics = nullptr;
  const FeltField* felt = nullptr;  ///< null for loops whose perception is not computed
  double sensation_level = 0.0;     ///< of `felt` [dB]; NaN without vibration
  SensationInterval sensation_interval;
  const Metrics* felt_metrics = nullptr;  ///< null without a target, too
  const Ghosts* ghosts = nullptr;         ///< null without a target, too
  std::vector<FeltHarmonic> spectrum;     ///< empty unless requested; also empty if `felt` is null
  std::vector<SettingsGroup> settings;    ///< of every stage
  std::string program;  ///< version of the program, written as "prostm" if not empty
};
std::string physical_to_json(const PhysicalReport& report);

}  // namespace prostm
