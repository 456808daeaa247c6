#include "prostm/plan/preset.hpp"

#include <vector>

namespace prostm {

std::string presets_with(bool (*has)(const PresetTraits& traits)) {
  std::vector<std::string_view> names;
  for (const PresetTraits& traits : kPresetTraits) {
    if (has(traits)) names.push_back(traits.name);
  }
  std::string out = names.size() == 1 ? "preset " : "presets ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) out += i + 1 < names.size() ? ", " : " and ";
    out += names[i];
  }
  return out;
}

}  // namespace prostm
