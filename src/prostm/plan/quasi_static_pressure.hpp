#pragma once
/// Eq. (1) at points whose closest point is known.

#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "prostm/plan/closest_point.hpp"
#include "prostm/plan/quasi_static.hpp"

namespace prostm {

/// The pressures of quasi_static_field(), point by point. Refers to `instead`. Allocates nothing.
class QuasiStaticPressure {
 public:
  /// See quasi_static_field().
  QuasiStaticPressure(const Plan& plan, int patch, double sigma, const GainLaw& gain,
                      const SegmentPressures* instead);
  /// Returns p [unit of the target]. @param nearest of PathSegments of the same plan and patch.
  double at(const ClosestPoint& nearest) const;

 private:
  // for each segment of the patch: its number in the plan, and γ of its path; 1 for a focus
  struct Origin {
    std::size_t number;
    double gain;
  };
  boost::container::static_vector<Origin, PathSegments::kCapacity> origins_;
  double exponent_;
  const SegmentPressures* instead_;
};

}  // namespace prostm
