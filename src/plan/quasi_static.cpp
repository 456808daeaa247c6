#include "plan/quasi_static.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "plan/closest_point.hpp"

namespace prostm {

void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        const GainLaw& gain, std::span<double> out) {
  PathSegments segments(plan, patch);
  if (segments.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  // γ of each segment's path, 1 of a focus
  boost::container::static_vector<double, PathSegments::kCapacity> gains;
  for (const FocalPath& path : plan.paths) {
    if (path.patch == patch) gains.resize(gains.size() + path.points.size(), gain.of(path.period));
  }
  gains.resize(segments.count(), 1.0);
  const double exponent = -0.5 / (sigma * sigma);
  for (int row = 0; row < raster.rows; ++row) {
    for (int col = 0; col < raster.cols; ++col) {
      const ClosestPoint nearest = segments.closest(raster.position(row, col));
      out[raster.index(row, col)] =
          nearest.pressure / gains[nearest.segment] * std::exp(exponent * nearest.distance2);
    }
  }
}

}  // namespace prostm
