#pragma once
/// Whether a machine holds the rates of a run in real time, judged from trials.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "prostm/pipeline/verdict.hpp"

namespace prostm {

/// The options of `prostm run` that a trial changes.
struct CheckedSetup {
  int cells = 0;  ///< --grid
  Preset preset = Preset::Best;
};
/// From the defaults to the cheapest.
std::span<const CheckedSetup> checked_setups();
/// "--grid 64 --preset best".
std::string options_of(const CheckedSetup& setup);

struct Trial {
  CheckedSetup setup;
  RunSummary summary;
  Verdict verdict;
  bool holds() const { return verdict.held.value_or(false); }
};

struct MachineAnswer {
  bool defaults_hold = false;
  std::optional<CheckedSetup> use;     ///< the first setup that held
  std::vector<std::string> sentences;  ///< what to tell, and what to do
};

/// @param trials of checked_setups() in their order; the first is of the defaults, and only the
/// last may have held.
MachineAnswer answer_of(std::span<const Trial> trials);

}  // namespace prostm
