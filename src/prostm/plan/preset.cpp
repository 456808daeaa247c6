#include "prostm/plan/preset.hpp"

#include <vector>

namespace prostm {

std::string presets_with(bool (*has)(const PresetTraits& traits)) {
  std::vector<std::string> names;
  for (const PresetTraits& traits : kPresetTraits)
    if (has(traits)) names.emplace_back(traits.name);
  return (names.size() == 1 ? "preset " : "presets ") + listed(names, "and");
}

std::string preset_choices() {
  std::vector<std::string> entries;
  for (const PresetTraits& traits : kPresetTraits) {
    const bool is_default = traits.name == name_of(kDefaultPreset);
    entries.push_back(std::string(traits.name) + (is_default ? " (default)" : ""));
  }
  return listed(entries);
}

}  // namespace prostm
