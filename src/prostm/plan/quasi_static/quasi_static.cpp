#include "prostm/plan/quasi_static/quasi_static.hpp"

#include <algorithm>

namespace prostm {

void quasi_static_field(const Plan& plan, int patch, const TargetField& raster, double sigma,
                        const GainLaw& gain, std::span<double> out,
                        const SegmentPressures* instead) {
  PathSegments segments(plan, patch);
  if (segments.empty()) {
    std::fill(out.begin(), out.end(), 0.0);
    return;
  }
  const QuasiStaticPressure pressure(plan, patch, sigma, gain, instead);
  segments.for_closest(raster, 0, raster.rows, [&](std::size_t cell, const ClosestPoint& nearest) {
    out[cell] = pressure.at(nearest);
  });
}

}  // namespace prostm
