#pragma once
/// Eq. (1) at points whose closest point is known.

#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <vector>

#include "prostm/plan/gain.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"

namespace prostm {

/// Rendered pressures along a plan's segments that replace its own p_i, e.g. the emitted ones. Each
/// segment of each path in turn, then each focus, has one or more values, evenly spaced from the
/// segment's first point to its second.
struct SegmentPressures {
  std::vector<double> pressure;  ///< unit of the target
  std::vector<std::size_t> end;  ///< end of each segment's values in `pressure`

  /// Interpolates along a segment. @param along 0 at the segment's first point, 1 at its second.
  double at(std::size_t segment, double along) const;
};

/// Evaluates the field of quasi_static_field() point by point. Keeps a reference to `instead`.
/// Allocates nothing.
class QuasiStaticPressure {
 public:
  /// See quasi_static_field().
  QuasiStaticPressure(const Plan& plan, int patch, double sigma, const GainLaw& gain,
                      const SegmentPressures* instead);
  /// Returns p [unit of the target]. @param nearest of PathSegments of the same plan and patch.
  double at(const ClosestPoint& nearest) const;

 private:
  // for each segment of the patch: its index in the plan, and γ of its path (1 for a focus)
  struct Origin {
    std::size_t number;
    double gain;
  };
  boost::container::static_vector<Origin, PathSegments::kCapacity> origins_;
  double exponent_;
  const SegmentPressures* instead_;
};

}  // namespace prostm
