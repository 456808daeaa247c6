#pragma once
/// Scores of many fields and plans on one target. Private to score.

#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"
#include "prostm/score/detail/skin_blur.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

/// Returns the closest point of a patch's paths or foci for each cell of a raster; empty without
/// paths and foci. @param pool shares the work where one is given.
std::vector<ClosestPoint> closest_points(const TargetField& raster, const Plan& plan, int patch,
                                         WorkerPool* pool = nullptr);

/// The part of score_field and score_plan that depends on the target alone, computed once.
class Scorer {
 public:
  /// Refers to the target, which must outlive it.
  /// @param pool shares the work where one is given; it must outlive this.
  explicit Scorer(const TargetField& target, WorkerPool* pool = nullptr);
  /// The same as score_field().
  Metrics field(const std::vector<double>& rendered, double coverage) const;
  /// The same as score_plan().
  Metrics plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
               const SegmentPressures* instead = nullptr) const;
  /// The same, from the plan's closest points. @param nearest of closest_points(), not empty.
  Metrics plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
               const std::vector<ClosestPoint>& nearest,
               const SegmentPressures* instead = nullptr) const;

 private:
  /// The values of a field on skin, over the target's maximum.
  std::vector<double> on_skin(const std::vector<double>& field) const;

  const TargetField& target_;
  double maximum_;
  WorkerPool* pool_;
  SkinBlur blur_;
  std::vector<std::size_t> cells_;       // of skin
  std::vector<double> share_, blurred_;  // the target over its maximum, on skin
};

}  // namespace prostm
