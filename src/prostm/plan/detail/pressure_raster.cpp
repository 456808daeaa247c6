#include "prostm/plan/detail/pressure_raster.hpp"

#include <array>
#include <cmath>

#include "prostm/target/pressure_share.hpp"

namespace prostm::planning {
namespace {

/// Weights of the four neighbours of a Catmull-Rom spline (a = −1/2) and their derivatives, at t in
/// [0, 1).
struct CubicWeights {
  std::array<double, 4> value, slope;
  explicit CubicWeights(double t)
      : value{((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0,
              ((-1.5 * t + 2.0) * t + 0.5) * t, (0.5 * t - 0.5) * t * t},
        slope{(-1.5 * t + 2.0) * t - 0.5, (4.5 * t - 5.0) * t, (-4.5 * t + 4.0) * t + 0.5,
              (1.5 * t - 1.0) * t} {}
};

}  // namespace

void PressureRaster::set(const TargetField& target, double maximum) {
  rows_ = target.rows;
  cols_ = target.cols;
  cell_ = kMmPerMetre * target.cell;
  value_.resize(target.size());
  for (std::size_t i = 0; i < value_.size(); ++i) {
    value_[i] = target.skin[i] != 0 ? pressure_share(target.pressure[i], maximum) : 0.0;
  }
}

PressureSample PressureRaster::sample(const Vec2& x) const {
  // more than two cells off the raster, all sixteen neighbours are zero
  const double u = x.x() / cell_, v = x.y() / cell_;
  if (!(u > -2.0 && u < cols_ + 1.0 && v > -2.0 && v < rows_ + 1.0)) return {};
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const CubicWeights a(u - i), b(v - j);

  // the 4×4 neighbourhood; near the border a copy, with zeros beyond the raster
  std::array<double, 16> copy;
  const double* p = copy.data();
  std::ptrdiff_t stride = 4;
  if (i >= 1 && i + 2 < cols_ && j >= 1 && j + 2 < rows_) {
    stride = cols_;
    p = value_.data() + (j - 1) * stride + (i - 1);
  } else {
    copy_neighbourhood(i - 1, j - 1, copy);
  }

  // cubic along the rows, then across them
  double value = 0.0, along_x = 0.0, along_y = 0.0;
  for (std::size_t m = 0; m < 4; ++m, p += stride) {
    const double row_value =
        a.value[0] * p[0] + a.value[1] * p[1] + a.value[2] * p[2] + a.value[3] * p[3];
    const double row_slope =
        a.slope[0] * p[0] + a.slope[1] * p[1] + a.slope[2] * p[2] + a.slope[3] * p[3];
    value += b.value[m] * row_value;
    along_x += b.value[m] * row_slope;
    along_y += b.slope[m] * row_value;
  }
  return {value, Vec2(along_x, along_y) / cell_};
}

void PressureRaster::copy_neighbourhood(int first_col, int first_row,
                                        std::array<double, 16>& copy) const {
  std::size_t k = 0;
  for (int row = first_row; row < first_row + 4; ++row) {
    for (int col = first_col; col < first_col + 4; ++col, ++k) {
      const bool inside = row >= 0 && row < rows_ && col >= 0 && col < cols_;
      copy[k] = inside ? value_[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
                                static_cast<std::size_t>(col)]
                       : 0.0;
    }
  }
}

}  // namespace prostm::planning
