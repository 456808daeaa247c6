#include "prostm/plan/quasi_static.hpp"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "prostm/plan/closest_point.hpp"

namespace prostm {

double SegmentPressures::at(std::size_t segment, double along) const {
  const std::size_t begin = segment > 0 ? end[segment - 1] : 0, last = end[segment] - 1 - begin;
  const double place = along * static_cast<double>(last);
  const std::size_t low = std::min(static_cast<std::size_t>(place), last);
  const double from = pressure[begin + low], to = pressure[begin + std::min(low + 1, last)];
  return from + (place - static_cast<double>(low)) * (to - from);
}

void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        const GainLaw& gain, std::span<double> out,
                        const SegmentPressures* instead) {
  PathSegments segments(plan, patch);
  if (segments.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  // for each segment of the patch: its number in the plan, and γ of its path; 1 for a focus
  struct Origin {
    std::size_t number;
    double gain;
  };
  boost::container::static_vector<Origin, PathSegments::kCapacity> origins;
  std::size_t number = 0;
  for (const FocalPath& path : plan.paths) {
    const double own = gain.of(path.period);
    for (std::size_t i = 0; i < path.points.size(); ++i, ++number) {
      if (path.patch == patch) origins.push_back({number, own});
    }
  }
  for (const FocalPoint& focus : plan.foci) {
    if (focus.patch == patch) origins.push_back({number, 1.0});
    ++number;
  }
  const double exponent = -0.5 / (sigma * sigma);
  for (int row = 0; row < raster.rows; ++row) {
    for (int col = 0; col < raster.cols; ++col) {
      const ClosestPoint nearest = segments.closest(raster.position(row, col));
      const Origin& origin = origins[nearest.segment];
      const double pressure =
          instead != nullptr ? instead->at(origin.number, nearest.along) : nearest.pressure;
      out[raster.index(row, col)] = pressure / origin.gain * std::exp(exponent * nearest.distance2);
    }
  }
}

}  // namespace prostm
