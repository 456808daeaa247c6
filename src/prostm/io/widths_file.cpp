#include "prostm/io/widths_file.hpp"

#include <nlohmann/json.hpp>

#include "prostm/core/text/json.hpp"
#include "prostm/core/units.hpp"

namespace prostm {

std::string widths_to_json(const std::string& array, std::span<const FocusWidthEntry> widths) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const FocusWidthEntry& e : widths) {
    rows.push_back({{"height_mm", to_milli(e.height)},
                    {"offset_mm", to_milli(e.offset)},
                    {"tilt_deg", e.tilt * 180.0 / kPi},
                    {"sigma_along_mm", to_milli(e.width.along)},
                    {"sigma_across_mm", to_milli(e.width.across)},
                    {"pressure_pa", e.width.level}});
  }
  return to_text({{"format", "prostm-widths/1"}, {"array", array}, {"widths", rows}});
}

}  // namespace prostm
