#include "plan/quasi_static.hpp"

#include <algorithm>
#include <cmath>

#include "plan/closest_point.hpp"

namespace prostm {

void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        double gain, std::span<double> out) {
  PathSegments segments(plan, patch);
  if (segments.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  const double exponent = -0.5 / (sigma * sigma);
  for (int row = 0; row < raster.rows; ++row) {
    for (int col = 0; col < raster.cols; ++col) {
      const ClosestPoint nearest = segments.closest(raster.position(row, col));
      out[raster.index(row, col)] =
          nearest.pressure / gain * std::exp(exponent * nearest.distance2);
    }
  }
}

}  // namespace prostm
