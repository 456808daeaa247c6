#include "prostm/plan/quasi_static/quasi_static_pressure.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {

double SegmentPressures::at(std::size_t segment, double along) const {
  const std::size_t begin = segment > 0 ? end[segment - 1] : 0, last = end[segment] - 1 - begin;
  const double place = along * static_cast<double>(last);
  const std::size_t low = std::min(static_cast<std::size_t>(place), last);
  const double from = pressure[begin + low], to = pressure[begin + std::min(low + 1, last)];
  return from + (place - static_cast<double>(low)) * (to - from);
}

QuasiStaticPressure::QuasiStaticPressure(const Plan& plan, int patch, double sigma,
                                         const GainLaw& gain, const SegmentPressures* instead)
    : exponent_(-0.5 / (sigma * sigma)), instead_(instead) {
  std::size_t number = 0;
  for (const FocalPath& path : plan.paths) {
    const double own = gain.of(path.period);
    for (std::size_t i = 0; i < path.points.size(); ++i, ++number) {
      if (path.patch == patch) origins_.push_back({number, own});
    }
  }
  for (const FocalPoint& focus : plan.foci) {
    if (focus.patch == patch) origins_.push_back({number, 1.0});
    ++number;
  }
}

double QuasiStaticPressure::at(const ClosestPoint& nearest) const {
  const Origin& origin = origins_[nearest.segment];
  const double pressure =
      instead_ != nullptr ? instead_->at(origin.number, nearest.along) : nearest.pressure;
  return pressure / origin.gain * std::exp(exponent_ * nearest.distance2);
}

}  // namespace prostm
