#include "prostm/io/detail/raster_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/target/rounding.hpp"

namespace prostm {

double checked_cell(double cell_mm, const std::string& file, const std::string& what) {
  if (!std::isfinite(cell_mm) || cell_mm < 0.01 || cell_mm > 1000.0) {
    throw InputError(fmt::format(
        "{}: {} is {}; it must be the edge of a cell, from 0.01 to 1000 mm", file, what, cell_mm));
  }
  return from_milli(cell_mm);
}

void check_raster_size(double rows, double cols, const std::string& file) {
  if (rows < 1 || cols < 1 || rows * cols > static_cast<double>(kMaxFieldCells)) {
    throw InputError(fmt::format("{}: has {} x {} cells; a field must have from 1 to {} cells",
                                 file, rows, cols, kMaxFieldCells));
  }
}

void settle_pressures(TargetField& field, const std::string& file) {
  clear_rounding(field);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const double pressure = field.pressure[field.index(row, col)];
      if (std::isfinite(pressure) && pressure >= 0.0 && pressure <= kMaxFilePressure) continue;
      throw InputError(
          fmt::format("{}: the pressure at row {}, column {} is {}; it must be from 0 to {}, or no "
                      "value where there is no skin",
                      file, row, col, pressure, kMaxFilePressure));
    }
  }
}

void read_raster(const JsonNode& node, TargetField& field) {
  const JsonNode cell = node.at("cell_mm", "the edge of a cell in mm");
  if (cell.value().is_array()) {
    cell.fail(
        "is an array; cells are square, so resample the field onto square cells, e.g. with "
        "scipy.ndimage.zoom");
  }
  constexpr double kAnyNumber = 1e308;
  field.cell = checked_cell(cell.number(-kAnyNumber, kAnyNumber), node.file(), "\"cell_mm\"");
  const Vec2 origin_mm = node.at("origin_mm", "[x, y] of the centre of the first cell in mm")
                             .vec2(-kMaxCoordinateMm, kMaxCoordinateMm);
  field.origin = Vec2(from_milli(origin_mm.x()), from_milli(origin_mm.y()));

  // check the size before allocating
  constexpr int kAnyCount = 1'000'000'000;
  const int rows = node.at("rows", "the number of rows").integer(-kAnyCount, kAnyCount);
  const int cols = node.at("cols", "the number of columns").integer(-kAnyCount, kAnyCount);
  check_raster_size(rows, cols, node.file());
  field.resize(rows, cols);
}

void check_matrix(const JsonNode& node, const TargetField& field) {
  if (node.array_size() != static_cast<std::size_t>(field.rows)) {
    node.fail(
        fmt::format("has {} rows; it must have \"rows\" = {}", node.array_size(), field.rows));
  }
  for (std::size_t row = 0; row < node.array_size(); ++row) {
    const JsonNode line = node.at(row);
    if (line.array_size() != static_cast<std::size_t>(field.cols)) {
      line.fail(fmt::format("has {} numbers; every row must have \"cols\" = {}", line.array_size(),
                            field.cols));
    }
    for (std::size_t col = 0; col < line.array_size(); ++col) {
      const nlohmann::json& value = line.value()[col];
      if (!value.is_number() && !value.is_null()) {
        line.at(col).fail("is not a number; it must be a number, or null where there is no skin");
      }
    }
  }
}

void read_heights(const JsonNode& node, TargetField& field) {
  check_matrix(node, field);
  for (int row = 0; row < field.rows; ++row) {
    const JsonNode line = node.at(static_cast<std::size_t>(row));
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      if (field.skin[i] == 0) continue;
      const auto c = static_cast<std::size_t>(col);
      if (line.value()[c].is_null()) line.at(c).fail("is null; there is skin, which has a height");
      field.height[i] = from_milli(line.at(c).number(-kMaxCoordinateMm, kMaxCoordinateMm));
    }
  }
  fill_heights(field);
}

Pose read_plane(const JsonNode& node) {
  node.allow_only({"origin_mm", "x", "y"});
  const Vec3 origin_mm =
      node.at("origin_mm", "[x, y, z] in mm, frame D").vec3(-kMaxCoordinateMm, kMaxCoordinateMm);
  const Vec3 x = node.at("x", "the plane's x axis, [x, y, z] in frame D")
                     .vec3(-kMaxCoordinateMm, kMaxCoordinateMm);
  const Vec3 y = node.at("y", "the plane's y axis, [x, y, z] in frame D")
                     .vec3(-kMaxCoordinateMm, kMaxCoordinateMm);
  constexpr double kTolerance = 1e-6;
  if (std::abs(x.norm() - 1.0) > kTolerance || std::abs(y.norm() - 1.0) > kTolerance ||
      std::abs(x.dot(y)) > kTolerance) {
    node.fail(
        fmt::format("has axes of length {} and {} with dot product {}; x and y must be unit "
                    "vectors at a right angle, to within {}",
                    x.norm(), y.norm(), x.dot(y), kTolerance));
  }

  if (x.cross(y).z() < -kTolerance) {
    node.fail(
        "faces away from the array, as x × y does; heights along it must lead away from the "
        "array, so reverse one of the axes");
  }

  // exact axes stay bit-identical
  Eigen::Matrix3d R;
  constexpr double kRounding = 1e-12;
  const bool exact = std::abs(x.squaredNorm() - 1.0) <= kRounding &&
                     std::abs(y.squaredNorm() - 1.0) <= kRounding &&
                     std::abs(x.dot(y)) <= kRounding;
  R.col(0) = exact ? x : x.normalized();
  R.col(1) = exact ? y : (y - R.col(0).dot(y) * R.col(0)).normalized();
  R.col(2) = R.col(0).cross(R.col(1));
  Pose X_DP = Pose::Identity();
  X_DP.linear() = R;
  X_DP.translation() = origin_mm.unaryExpr([](double mm) { return from_milli(mm); });
  return X_DP;
}

void write_raster(const TargetField& field, nlohmann::ordered_json& object) {
  object["cell_mm"] = to_milli(field.cell);
  object["origin_mm"] = milli_json(field.origin);
  object["rows"] = field.rows;
  object["cols"] = field.cols;
}

nlohmann::ordered_json heights_json(const TargetField& field) {
  auto matrix = nlohmann::ordered_json::array();
  for (int row = 0; row < field.rows; ++row) {
    auto line = nlohmann::ordered_json::array();
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      line.push_back(field.skin[i] != 0 ? nlohmann::ordered_json(to_milli(field.height[i]))
                                        : nlohmann::ordered_json(nullptr));
    }
    matrix.push_back(std::move(line));
  }
  return matrix;
}

nlohmann::ordered_json plane_json(const Pose& X_DP) {
  const auto axis = [&](int i) {
    const Vec3 a = X_DP.linear().col(i);
    return nlohmann::ordered_json{a.x(), a.y(), a.z()};
  };
  return {{"origin_mm", milli_json(Vec3(X_DP.translation()))}, {"x", axis(0)}, {"y", axis(1)}};
}

}  // namespace prostm
