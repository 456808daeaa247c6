#include "prostm/score/disturbance.hpp"

#include <cmath>

#include "prostm/core/units.hpp"

namespace prostm {
std::vector<Disturbance> disturbances(double sigma) {
  constexpr double kFocus = 3.9e-3, kHand = 3e-3, kTracker = 5e-3;  // [m]
  return {{"array's own focus, 3.9 mm", kFocus, 0.0},
          {"sigma - 30 %", 0.7 * sigma, 0.0},
          {"sigma + 30 %", 1.3 * sigma, 0.0},
          {"hand displaced by 3 mm", sigma, kHand},
          {"tracker wrong by 5 mm", sigma, kTracker}};
}

Metrics score_shifted(const TargetField& target, const Plan& plan, int patch, double sigma,
                      const GainLaw& gain, const Vec2& shift) {
  Plan moved = plan;
  translate(moved, shift);
  return score_plan(target, moved, patch, sigma, gain);
}

Metrics score_disturbed(const TargetField& target, const Plan& plan, int patch,
                        const Disturbance& d, const GainLaw& gain) {
  if (d.shift == 0.0) return score_plan(target, plan, patch, d.sigma, gain);
  std::vector<Metrics> shifted;
  for (int k = 0; k < kShiftDirections; ++k) {
    const double angle = 2.0 * kPi * k / kShiftDirections;
    shifted.push_back(score_shifted(target, plan, patch, d.sigma, gain,
                                    d.shift * Vec2(std::cos(angle), std::sin(angle))));
  }
  return mean(shifted);
}

}  // namespace prostm
