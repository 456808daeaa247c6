#include "report/metrics_table.hpp"

#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"

namespace prostm::app {

std::vector<report::Column> metrics_columns(const std::string& heading) {
  return {{"name", heading},       {"rmse", "RMSE"},       {"correlation", "correlation"},
          {"skill_8", "skill_8"},  {"overlap", "overlap"}, {"spill", "spill"},
          {"coverage", "coverage"}};
}

nlohmann::ordered_json metrics_row(const std::string& name, const Metrics& m) {
  return {{"name", name},          {"rmse", m.rmse},       {"correlation", m.correlation},
          {"skill_8", m.skill_8},  {"overlap", m.overlap}, {"spill", m.spill},
          {"coverage", m.coverage}};
}

nlohmann::ordered_json sensation_value(double percept) {
  const double level = sensation_level(percept, usx_array());
  if (std::isnan(level)) return nullptr;
  return level;
}

}  // namespace prostm::app
