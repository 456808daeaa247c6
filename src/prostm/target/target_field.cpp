#include "prostm/target/target_field.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace prostm {
namespace {

// tolerance for the orthonormality of poses from files or fits
constexpr double kOrthonormalTolerance = 1e-6;

std::string text(double value) {
  std::array<char, 32> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string cell_name(int row, int col) {
  return "row " + std::to_string(row) + ", column " + std::to_string(col);
}

// replaces Eigen's allFinite, which subtracts: an invalid operation on infinities
template <class Derived>
bool all_finite(const Eigen::MatrixBase<Derived>& values) {
  return values.unaryExpr([](double x) { return std::isfinite(x); }).all();
}

void validate_shape(const TargetField& field) {
  const auto size_text = std::to_string(field.rows) + " x " + std::to_string(field.cols);
  if (field.rows < 1 || field.cols < 1) {
    throw std::invalid_argument("a raster of " + size_text +
                                " cells must have at least one row and one column");
  }
  const std::size_t cells =
      static_cast<std::size_t>(field.rows) * static_cast<std::size_t>(field.cols);
  if (cells > kMaxFieldCells) {
    throw std::invalid_argument("a raster of " + size_text + " cells must have at most " +
                                std::to_string(kMaxFieldCells) + " cells");
  }
  if (field.pressure.size() != cells || field.skin.size() != cells ||
      field.height.size() != cells) {
    throw std::invalid_argument("a raster of " + size_text +
                                " cells must have as many pressures, skin flags and heights, not " +
                                std::to_string(field.pressure.size()) + ", " +
                                std::to_string(field.skin.size()) + " and " +
                                std::to_string(field.height.size()));
  }
  if (!field.weight.empty() && field.weight.size() != cells) {
    throw std::invalid_argument("a raster of " + size_text +
                                " cells must have as many weights or none, not " +
                                std::to_string(field.weight.size()));
  }
  if (field.smoke.size() != field.movement.size() ||
      (!field.smoke.empty() && field.smoke.size() != cells)) {
    throw std::invalid_argument("a raster of " + size_text +
                                " cells must have as many values of each part of its pressure or "
                                "none, not " +
                                std::to_string(field.smoke.size()) + " and " +
                                std::to_string(field.movement.size()));
  }
  if (!std::isfinite(field.cell) || field.cell <= 0.0) {
    throw std::invalid_argument("cell = " + text(field.cell) + " m must be positive and finite");
  }
  if (!all_finite(field.origin)) throw std::invalid_argument("the raster's origin must be finite");
}

void validate_plane(const Pose& X_DP) {
  if (!all_finite(X_DP.matrix())) throw std::invalid_argument("the plane's pose must be finite");
  const Eigen::Matrix3d R = X_DP.linear();
  // entries of a rotation are at most 1; checked first, since large ones would overflow the product
  const bool bounded = R.cwiseAbs().maxCoeff() < 2.0;
  if (!bounded ||
      (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() >
          kOrthonormalTolerance ||
      R.determinant() < 0.0) {
    throw std::invalid_argument("the plane's axes must be orthonormal and right-handed to within " +
                                text(kOrthonormalTolerance));
  }
}

void validate_weights(const TargetField& field) {
  if (field.weight.empty()) return;
  bool has_skin = false;
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      const double w = field.weight[i];
      if (!std::isfinite(w) || w < 0.0) {
        throw std::invalid_argument("weight = " + text(w) + " at " + cell_name(row, col) +
                                    " must be at least 0 and finite");
      }
      has_skin = has_skin || field.skin[i] != 0;
    }
  }
  if (has_skin && max_weight(field) == 0.0) {
    throw std::invalid_argument(
        "weights that are 0 on all skin leave nothing to plan for; at "
        "least one must be above 0");
  }
}

void validate_part(const TargetField& field, const char* name, const std::vector<double>& part) {
  const auto wrong =
      std::find_if_not(part.begin(), part.end(), [](double p) { return std::isfinite(p); });
  if (wrong == part.end()) return;
  const auto at = static_cast<int>(wrong - part.begin());
  throw std::invalid_argument(std::string(name) + " = " + text(*wrong) + " at " +
                              cell_name(at / field.cols, at % field.cols) + " must be finite");
}

}  // namespace

void TargetField::resize(int new_rows, int new_cols) {
  rows = new_rows;
  cols = new_cols;
  const std::size_t cells = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  pressure.assign(cells, 0.0);
  skin.assign(cells, 0);
  height.assign(cells, 0.0);
  weight.clear();
  smoke.clear();
  movement.clear();
}

Pose TargetField::default_plane() {
  Pose X_DP = Pose::Identity();
  X_DP.translation().z() = 0.200;
  return X_DP;
}

void validate(const TargetField& field) {
  validate_shape(field);
  validate_plane(field.X_DP);
  for (int row = 0; row < field.rows; ++row) {
    for (int col = 0; col < field.cols; ++col) {
      const std::size_t i = field.index(row, col);
      const double p = field.pressure[i];
      if (!std::isfinite(p) || p < 0.0) {
        throw std::invalid_argument("pressure = " + text(p) + " at " + cell_name(row, col) +
                                    " must be at least 0 and finite");
      }
      if (field.skin[i] == 0 && p > 0.0) {
        throw std::invalid_argument("pressure = " + text(p) + " at " + cell_name(row, col) +
                                    " must be 0, because there is no skin");
      }
      if (!std::isfinite(field.height[i])) {
        throw std::invalid_argument("height = " + text(field.height[i]) + " m at " +
                                    cell_name(row, col) + " must be finite");
      }
    }
  }
  validate_weights(field);
  validate_part(field, "smoke", field.smoke);
  validate_part(field, "movement", field.movement);
}

double max_pressure(const TargetField& field) {
  double largest = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) largest = std::max(largest, field.pressure[i]);
  }
  return largest;
}

double total_pressure(const TargetField& field) {
  double sum = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i)
    sum += field.skin[i] != 0 ? field.pressure[i] : 0.0;
  return sum;
}

double max_weight(const TargetField& field) {
  double largest = 0.0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) largest = std::max(largest, field.weight[i]);
  }
  return largest;
}

void fill_heights(TargetField& field) {
  std::vector<std::uint32_t> queue;
  fill_heights(field, queue);
}

void fill_heights(TargetField& field, std::vector<std::uint32_t>& queue) {
  constexpr std::uint8_t kReached = 2;  // marks cells without skin that the front has reached
  queue.clear();
  queue.reserve(field.size());

  // the front starts from all skin at once
  for (std::size_t i = 0; i < field.size(); ++i) {
    if (field.skin[i] != 0) queue.push_back(static_cast<std::uint32_t>(i));
  }
  if (queue.empty()) {
    std::fill(field.height.begin(), field.height.end(), 0.0);
    return;
  }

  // each cell passes its height to its row and column neighbours that have none yet
  const auto cols = static_cast<std::uint32_t>(field.cols);
  const auto rows = static_cast<std::uint32_t>(field.rows);
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::uint32_t from = queue[head];
    const auto spread = [&](std::uint32_t to) {
      if (field.skin[to] != 0) return;
      field.skin[to] = kReached;
      field.height[to] = field.height[from];
      queue.push_back(to);
    };
    const std::uint32_t row = from / cols, col = from % cols;
    if (row > 0) spread(from - cols);
    if (col > 0) spread(from - 1);
    if (col + 1 < cols) spread(from + 1);
    if (row + 1 < rows) spread(from + cols);
  }
  for (std::uint8_t& s : field.skin) s = s == kReached ? 0 : s;
}

double height_at(const TargetField& field, const Vec2& x) {
  // cell coordinates, clamped to the centres of the border cells
  const Vec2 u = (x - field.origin) / field.cell;
  const double col = std::clamp(u.x(), 0.0, static_cast<double>(field.cols - 1));
  const double row = std::clamp(u.y(), 0.0, static_cast<double>(field.rows - 1));
  const int c0 = std::min(static_cast<int>(col), std::max(field.cols - 2, 0));
  const int r0 = std::min(static_cast<int>(row), std::max(field.rows - 2, 0));
  const int c1 = std::min(c0 + 1, field.cols - 1), r1 = std::min(r0 + 1, field.rows - 1);
  const double s = col - c0, t = row - r0;

  // bilinear between the four centres around the point
  const auto h = [&](int r, int c) { return field.height[field.index(r, c)]; };
  return (1.0 - t) * ((1.0 - s) * h(r0, c0) + s * h(r0, c1)) +
         t * ((1.0 - s) * h(r1, c0) + s * h(r1, c1));
}

}  // namespace prostm
