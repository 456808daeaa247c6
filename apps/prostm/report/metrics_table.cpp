#include "report/metrics_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::app {

std::string at_common_width(const std::string& quantity) {
  return fmt::format("{} at σ = {:.1f} mm", quantity, 1e3 * PlanSettings().sigma);
}

std::vector<report::Column> metrics_columns(const std::string& heading, bool felt) {
  const auto name = [&](const char* quantity) {
    return felt ? at_common_width(quantity) : std::string(quantity);
  };
  std::vector<report::Column> out = {{"name", heading}, {"shape", name("shape by Eq. (1)"), "", 2}};
  if (felt) {
    out.push_back({"felt_shape", "felt shape", "", 2});
    out.push_back({"felt_strength", "felt strength", "dB above threshold", 1});
  }
  for (const report::Column& column : {report::Column{"spill", name("spill")},
                                       {"rmse", "RMSE by Eq. (1)"},
                                       {"correlation", "correlation by Eq. (1)"},
                                       {"skill_8", "S_8.5 by Eq. (1)"},
                                       {"overlap", "overlap by Eq. (1)"},
                                       {"coverage", "coverage"}})
    out.push_back(column);
  return out;
}

nlohmann::ordered_json metrics_row(const std::string& name, const Metrics& of_model,
                                   const Metrics* of_percept, double percept) {
  nlohmann::ordered_json row = {{"name", name}, {"shape", of_model.skill_0}};
  row["felt_shape"] = row["felt_strength"] = nullptr;
  if (of_percept != nullptr) {
    row["felt_shape"] = of_percept->skill_8;
    row["felt_strength"] = sensation_value(percept);
  }
  row["spill"] = of_model.spill;
  row["rmse"] = of_model.rmse;
  row["correlation"] = of_model.correlation;
  row["skill_8"] = of_model.skill_8;
  row["overlap"] = of_model.overlap;
  row["coverage"] = of_model.coverage;
  return row;
}

nlohmann::ordered_json sensation_value(double percept) {
  const double level = sensation_level(percept, usx_array());
  if (std::isnan(level)) return nullptr;
  return level;
}

}  // namespace prostm::app
