#pragma once
/// The presets of the planner, with their properties in one table.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "prostm/core/text/names.hpp"

namespace prostm {

/// How the paths of a preset are found.
enum class PathSearch : std::uint8_t {
  Paper,  ///< the paper's method: tour, split, descent
  Full,   ///< the nearest field, from several starts, with kicks
  Short   ///< the same from one start, on coarser cells
};

struct PresetTraits {
  std::string_view name;   ///< in files, on the command line and in Python
  std::string_view title;  ///< on the page
  PathSearch search = PathSearch::Paper;
  bool makes_valid = false;         ///< repairs or drops invalid paths (paper's method only)
  bool moves_fit_samples = false;   ///< moves fit_samples points of a path, not `samples`
  bool halves_segments = false;     ///< plans have two pieces for each segment that is moved
  bool chooses_by_percept = false;  ///< chooses number of paths and pressures by what is felt
  double live_budget = 0.0;         ///< PlanSettings::budget in real time [s]; 0: it takes none

  /// Returns whether paths are fitted to the field: settings fit_… and felt_… apply, plans are
  /// always valid, and PlanSettings::widths is used if not empty.
  constexpr bool is_fitted() const { return search != PathSearch::Paper; }
  /// Returns whether PlanSettings::budget bounds its time.
  constexpr bool takes_budget() const { return live_budget > 0.0; }
  /// Returns whether PlanSettings::felt_weight applies.
  constexpr bool takes_felt_weight() const { return is_fitted() && !chooses_by_percept; }
};

/// `paper`: exactly the paper's method; its violations of length and crossing are reported.
/// `paper-valid`: the same, then repaired to be valid. `best`: the paths whose field is nearest to
/// the target, always valid. `fast`: one short search of the same kind. `felt`: such a search for
/// each number of paths, of which the one is kept that is felt best.
enum class Preset : std::uint8_t { Paper, PaperValid, Best, Fast, Felt };

/// In the order of the enumerators.
inline constexpr std::array<PresetTraits, 5> kPresetTraits = {{
    {.name = "paper", .title = "Paper"},
    {.name = "paper-valid", .title = "Paper, made valid", .makes_valid = true},
    {.name = "best",
     .title = "Best",
     .search = PathSearch::Full,
     .moves_fit_samples = true,
     .halves_segments = true,
     .live_budget = 2e-3},
    {.name = "fast", .title = "Fast", .search = PathSearch::Short},
    {.name = "felt",
     .title = "Felt",
     .search = PathSearch::Short,
     .chooses_by_percept = true,
     .live_budget = 20e-3},
}};

inline constexpr Preset kDefaultPreset = Preset::Best;
inline constexpr Preset kCheapestPreset = Preset::Fast;

constexpr const PresetTraits& traits_of(Preset preset) {
  return kPresetTraits[static_cast<std::size_t>(preset)];
}

template <>
inline constexpr auto kNames<Preset> = [] {
  std::array<std::string_view, kPresetTraits.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPresetTraits[i].name;
  return names;
}();

/// Returns e.g. "preset best" or "presets best and fast": the presets for which `has` is true.
std::string presets_with(bool (*has)(const PresetTraits& traits));
/// Returns "paper, paper-valid, best (default), or fast", for the help of options.
std::string preset_choices();

}  // namespace prostm
