#pragma once
/// Decides from trials whether a machine keeps up in real time, and finds options with which it
/// does without a change of the scene's stimulus.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/pipeline/realtime/verdict.hpp"

namespace prostm {

/// The options of `prostm run` that a trial changes.
struct CheckedSetup {
  int cells = 0;  ///< --grid
  Preset preset = kDefaultPreset;
};
/// "--grid 64 --preset best".
std::string options_of(const CheckedSetup& setup);

/// Setups to try, from the defaults to the cheapest, with grids that keep the stimulus of at least
/// one of `scenes` (grid_effect()). @throws std::invalid_argument for an unknown scene.
std::vector<CheckedSetup> checked_setups(std::span<const std::string> scenes);

/// Every scene with a stimulus.
std::vector<std::string> stimulus_scenes();

struct MachineTrial {
  CheckedSetup setup;
  RunSummary summary;
  Verdict verdict;
  bool holds() const { return verdict.held.value_or(false); }
};

/// The recommended options for a scene.
struct SceneAnswer {
  std::string scene;
  std::optional<CheckedSetup> use;  ///< holds the rates and keeps the stimulus, if any
};

struct MachineAnswer {
  bool defaults_hold = false;
  std::vector<SceneAnswer> scenes;
  /// Options for all scenes; nothing if they differ, or a scene has none.
  std::optional<CheckedSetup> use;
  std::vector<std::string> sentences;  ///< results and remedies
};

/// Derives the answer from trials. @param trials the trials of checked_setups() in their order; the
/// first uses the defaults, and only the last may have held the rates.
MachineAnswer answer_of(std::span<const MachineTrial> trials, std::span<const std::string> scenes);

}  // namespace prostm
