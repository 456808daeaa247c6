#pragma once
/// Tables of metrics.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/report/part.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// @param heading of the first column.
std::vector<report::Column> metrics_columns(const std::string& heading);
nlohmann::ordered_json metrics_row(const std::string& name, const Metrics& metrics);
/// Returns the sensation level [dB] of a percept [m] from the array usx; null below every level.
nlohmann::ordered_json sensation_value(double percept);

}  // namespace prostm::app
