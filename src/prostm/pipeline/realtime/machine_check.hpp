#pragma once
/// Whether a machine holds the rates of a run in real time, and with which options that keep the
/// stimulus of a scene; judged from trials.

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

/// From the defaults to the cheapest, with the grids that keep the stimulus of one scene of
/// `scenes` at least (grid_effect). @throws std::invalid_argument for an unknown scene.
std::vector<CheckedSetup> checked_setups(std::span<const std::string> scenes);

/// Every scene with a stimulus.
std::vector<std::string> stimulus_scenes();

struct Trial {
  CheckedSetup setup;
  RunSummary summary;
  Verdict verdict;
  bool holds() const { return verdict.held.value_or(false); }
};

/// Options for a scene.
struct SceneAnswer {
  std::string scene;
  std::optional<CheckedSetup> use;  ///< holds the rates and keeps the stimulus; nothing: none does
};

struct MachineAnswer {
  bool defaults_hold = false;
  std::vector<SceneAnswer> scenes;
  /// Options for every scene; nothing where they differ, or a scene has none.
  std::optional<CheckedSetup> use;
  std::vector<std::string> sentences;  ///< what to tell, and what to do
};

/// @param trials of checked_setups() in their order; the first is of the defaults, and only the
/// last may have held.
MachineAnswer answer_of(std::span<const Trial> trials, std::span<const std::string> scenes);

}  // namespace prostm
