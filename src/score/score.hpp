#pragma once
/// How well a plan's quasi-static field (Eq. 1) renders its target, with the controls that keep the numbers honest.

#include <cstdint>
#include <string>
#include <vector>

#include "plan/plan.hpp"
#include "target/target_field.hpp"

namespace prostm {

/// Eqs. (Q1)–(Q7) of docs/design.md. All compare p̂ with p* over the skin cells, both divided by max p*.
struct Metrics {
  double rmse = 0;
  double correlation = 0;   ///< Pearson's; 0 when either field is constant
  double coverage = 0;      ///< share of Σ p* within σ of a path
  double skill_0 = 0;       ///< S_0: 1 − min_g Σ(p* − g p̂)² / Σ(p* − mean)²; 0 = a flat field
  double skill_8 = 0;       ///< S_8.5: the same after a Gaussian blur of 8.5 mm of both, within the skin
  double overlap = 0;       ///< Σ min(p*, g p̂) / Σ max(p*, g p̂), g of skill_0
  double spill = 0;         ///< share of Σ p̂ on skin where p* < 0.1 max p*
};

/// Scores a given field. @param rendered rows·cols, the effective field p̂. @param coverage is passed through.
Metrics score_field(const TargetField& target, const std::vector<double>& rendered, double coverage);

/// Scores a plan on one patch through Eq. (1) with σ [m] and γ.
Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma, double gain);

/// One row of the controls' table: what a metric says about something that must lose.
struct Control {
  std::string name;
  Metrics metrics;
};

/// The controls of a plan on a target: a flat field; four circles at the centre of mass (radius such that each is
/// `length` long, p = p* mean); random valid circles with least-squares pressures (median over 20 draws);
/// and, when `other` is given, the paths of that plan (for another target), moved to this target's centre of mass.
std::vector<Control> controls(const TargetField& target, double sigma, double gain, double length,
                              const Plan* other, std::uint64_t seed);

}  // namespace prostm
