#pragma once
/// Robustness scores: a plan under conditions that differ from the model it was optimised for,
/// (Q8)–(Q9) of docs/design/quality.md.

#include <string>
#include <vector>

#include "prostm/score/score.hpp"

namespace prostm {

/// A deviation of the rendering from the planner's Eq. (1).
struct Disturbance {
  std::string name;
  double sigma = 0.0;  ///< fall-off of a focal point in the rendering [m], > 0
  double shift = 0.0;  ///< shift of the paths in the plane [m], applied in kShiftDirections
};

/// Directions of a shift: 0°, 45°, …, 315°.
inline constexpr int kShiftDirections = 8;

/// Returns the standard disturbances of plans for `sigma` [m]: the array's own focus (σ = 3.9 mm),
/// σ 30 % less and 30 % more, the hand displaced by 3 mm, and the tracker's pose wrong by 5 mm.
std::vector<Disturbance> disturbances(double sigma);

/// Same as score_plan(), with every path moved by `shift` [m] in the plane: p̂(x) becomes
/// p̂(x − shift), (Q8).
Metrics score_shifted(const TargetField& target, const Plan& plan, int patch, double sigma,
                      const GainLaw& gain, const Vec2& shift);

/// Scores a plan on one patch under a disturbance. Coverage then means "within the disturbance's
/// σ". With a shift, each metric is the mean over the directions, (Q9). Without a shift and with
/// the planner's σ, the result equals score_plan() to the bit. @param gain γ of Eq. (1).
Metrics score_disturbed(const TargetField& target, const Plan& plan, int patch,
                        const Disturbance& disturbance, const GainLaw& gain);

}  // namespace prostm
