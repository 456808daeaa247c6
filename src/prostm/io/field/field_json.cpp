#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/io/detail/raster_json.hpp"
#include "prostm/io/field/field_file.hpp"

namespace prostm {
namespace {

/// Reads a matrix of weights, null off the skin, where they are 0.
void read_weights(const JsonNode& node, TargetField& field) {
  check_matrix(node, field);
  field.weight.assign(field.size(), 0.0);
  bool has_skin = false;
  for (int row = 0; row < field.rows; ++row) {
    const JsonNode line = node.at(static_cast<std::size_t>(row));
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      if (field.skin[i] == 0) continue;
      const auto c = static_cast<std::size_t>(col);
      if (line.value()[c].is_null()) line.at(c).fail("is null; there is skin, which has a weight");
      field.weight[i] = line.at(c).number(0.0, kMaxFileWeight);
      has_skin = true;
    }
  }
  if (has_skin && max_weight(field) == 0.0) {
    node.fail("is 0 on all skin; at least one weight must be above 0");
  }
}

/// The matrix of `values`, with null off the skin.
nlohmann::ordered_json matrix_json(const TargetField& field, const std::vector<double>& values) {
  auto matrix = nlohmann::ordered_json::array();
  for (int row = 0; row < field.rows; ++row) {
    auto line = nlohmann::ordered_json::array();
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      line.push_back(field.skin[i] != 0 ? nlohmann::ordered_json(values[i])
                                        : nlohmann::ordered_json(nullptr));
    }
    matrix.push_back(std::move(line));
  }
  return matrix;
}

}  // namespace

TargetField field_from_json(std::string_view text, const std::string& name) {
  const nlohmann::json document = parse_json(text, name);
  const JsonNode root(document, name);
  require_format(root, "prostm-field/1");
  root.allow_only({"format", "cell_mm", "origin_mm", "rows", "cols", "pressure", "height_mm",
                   "weight", "plane"});
  TargetField field;
  read_raster(root, field);

  // pressure, null where there is no skin
  const JsonNode pressure = root.at("pressure", "an array of rows of pressures");
  check_matrix(pressure, field);
  for (int row = 0; row < field.rows; ++row) {
    const nlohmann::json& line = pressure.value()[static_cast<std::size_t>(row)];
    for (int col = 0; col < field.cols; ++col) {
      const nlohmann::json& value = line[static_cast<std::size_t>(col)];
      if (value.is_null()) continue;
      field.skin[field.index(row, col)] = 1;
      field.pressure[field.index(row, col)] = value.get<double>();
    }
  }
  settle_pressures(field, name);

  if (root.has("height_mm")) read_heights(root.at("height_mm", ""), field);
  if (root.has("weight")) read_weights(root.at("weight", ""), field);
  if (root.has("plane")) field.X_DP = read_plane(root.at("plane", ""));
  return field;
}

std::string field_to_json(const TargetField& field) {
  nlohmann::ordered_json document = {{"format", "prostm-field/1"}};
  write_raster(field, document);
  document["pressure"] = matrix_json(field, field.pressure);
  const bool flat =
      std::all_of(field.height.begin(), field.height.end(), [](double h) { return h == 0.0; });
  if (!flat) document["height_mm"] = heights_json(field);
  if (!field.weight.empty()) document["weight"] = matrix_json(field, field.weight);
  document["plane"] = plane_json(field.X_DP);
  return to_text(document);
}

}  // namespace prostm
