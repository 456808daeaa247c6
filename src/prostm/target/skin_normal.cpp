#include "prostm/target/skin_normal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace prostm {

Vec3 skin_normal(const TargetField& field, int row, int col) {
  constexpr int kReach = 2;
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Vec3 right = Vec3::Zero();
  const double middle = field.height[field.index(row, col)];
  for (int j = std::max(row - kReach, 0); j <= std::min(row + kReach, field.rows - 1); ++j) {
    for (int i = std::max(col - kReach, 0); i <= std::min(col + kReach, field.cols - 1); ++i) {
      const std::size_t at = field.index(j, i);
      if (field.skin[at] == 0) continue;
      const Vec3 a(i - col, j - row, 1.0);  // in cells
      normal_matrix += a * a.transpose();
      right += (field.height[at] - middle) / field.cell * a;
    }
  }
  // slight damping sets undetermined slopes to 0 (across a row of cells, at an isolated cell), and
  // keeps the matrix invertible where there is no skin
  normal_matrix.diagonal().array() += 1e-9;
  const Vec3 slope = normal_matrix.ldlt().solve(right);
  return Vec3(slope.x(), slope.y(), -1.0).normalized();
}

}  // namespace prostm
