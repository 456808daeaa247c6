#pragma once
/// Tables of quality: shape by Eq. (1), felt shape, felt strength and spill, then other metrics.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "prostm/report/part.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

/// Names a quantity by Eq. (1) that is computed with the paper's σ for all methods. Commands use
/// the σ that each plan was made for.
std::string at_common_width(const std::string& quantity);
/// @param heading of the first column. @param felt whether there are columns of the percept; then
/// shape and spill have the names of at_common_width().
std::vector<report::Column> metrics_columns(const std::string& heading, bool felt = false);
/// @param of_model metrics by Eq. (1). @param of_percept metrics of the percept, if computed.
/// @param percept its strongest place, with the array usx at its nominal amplitude [m].
nlohmann::ordered_json metrics_row(const std::string& name, const Metrics& of_model,
                                   const Metrics* of_percept = nullptr, double percept = 0.0);
/// Returns the sensation level [dB] of a percept [m] from the array usx; null below every level.
nlohmann::ordered_json sensation_value(double percept);

}  // namespace prostm::app
