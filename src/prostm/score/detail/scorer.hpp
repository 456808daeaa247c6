#pragma once
/// Scores many fields and plans on one target. Private to score.

#include <vector>

#include "prostm/core/worker_pool.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"
#include "prostm/score/detail/skin_blur.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

/// Returns the closest point of a patch's paths or foci for each cell of a raster; empty without
/// paths and foci. @param pool runs the work in parallel if not null.
std::vector<ClosestPoint> closest_points(const TargetField& raster, const Plan& plan, int patch,
                                         WorkerPool* pool = nullptr);

/// The part of score_field and score_plan that depends on the target alone, computed once.
class Scorer {
 public:
  /// Keeps a reference to the target, which must outlive this.
  /// @param pool runs the work in parallel if not null; must outlive this.
  explicit Scorer(const TargetField& target, WorkerPool* pool = nullptr);
  /// Same as score_field().
  Metrics field(const std::vector<double>& rendered, double coverage) const;
  /// Same as score_plan().
  Metrics plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
               const SegmentPressures* instead = nullptr) const;
  /// Same, given the plan's closest points. @param nearest result of closest_points(), not empty.
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
  std::vector<std::size_t> cells_;       // indices of cells with skin
  std::vector<double> share_, blurred_;  // the target over its maximum, on skin
};

}  // namespace prostm
