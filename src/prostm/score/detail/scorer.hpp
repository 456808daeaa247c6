#pragma once
/// Scores of many fields and plans on one target. Private to score.

#include <vector>

#include "prostm/score/detail/skin_blur.hpp"
#include "prostm/score/score.hpp"

namespace prostm {

/// The part of score_field and score_plan that depends on the target alone, computed once.
class Scorer {
 public:
  /// Refers to the target, which must outlive it.
  explicit Scorer(const TargetField& target);
  /// The same as score_field().
  Metrics field(const std::vector<double>& rendered, double coverage) const;
  /// The same as score_plan().
  Metrics plan(const Plan& plan, int patch, double sigma, const GainLaw& gain,
               const SegmentPressures* instead = nullptr) const;

 private:
  const TargetField& target_;
  double maximum_;
  SkinBlur blur_;
  std::vector<double> share_, blurred_;  // the target over its maximum, on skin
};

}  // namespace prostm
