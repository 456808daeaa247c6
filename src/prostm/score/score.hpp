#pragma once
/// Scores of a plan's quasi-static field (Eq. 1) against its target, and scores of controls for
/// comparison.

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/core/random.hpp"
#include "prostm/plan/gain.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Eqs. (Q1)–(Q7) of docs/design/quality.md. All compare p̂ with p* over the skin cells, both
/// divided by max p*.
struct Metrics {
  double rmse = 0;
  double correlation = 0;  ///< Pearson's correlation; 0 if either field is constant
  double coverage = 0;     ///< share of Σ p* within σ of a path
  double skill_0 = 0;  ///< S_0: 1 − min_g Σ(p* − g p̂)² / Σ(p* − mean)²; 0 = a flat field
  double skill_8 = 0;  ///< S_8.5: S_0 after a Gaussian blur of both by 8.5 mm, within the skin
  double overlap = 0;  ///< Σ min(p*, g p̂) / Σ max(p*, g p̂), g of skill_0
  double spill = 0;    ///< share of Σ p̂ on skin where p* < 0.1 max p*
  /// S_8.5 of the percept of the field emitted by an array, plan_percept(); NaN if not computed.
  double felt_skill = std::numeric_limits<double>::quiet_NaN();
  /// Sensation level of that percept [dB], (S21); NaN if not computed.
  double sensation_level = std::numeric_limits<double>::quiet_NaN();
};
template <>
std::span<const Quantity<Metrics>> quantities<Metrics>();

/// Mean of each metric; NaN if any value is NaN. @pre `all` is not empty.
Metrics mean(std::span<const Metrics> all);
/// Median of each metric; NaN if any value is NaN. @pre as for mean().
Metrics median(std::span<const Metrics> all);

/// Scores a given field; all zeros for a target without pressure. @param rendered rows·cols, the
/// effective field p̂, in the unit of the target. @param coverage is passed through.
Metrics score_field(const TargetField& target, const std::vector<double>& rendered,
                    double coverage);

/// (Q3): the share of Σ p* within σ [m] of a path or focus of the patch; 0 for a target without
/// pressure.
double plan_coverage(const TargetField& target, const Plan& plan, int patch, double sigma);

/// Scores a plan on one patch through Eq. (1) with σ [m] and the γ of each path; all zeros for a
/// target without pressure. @param instead pressures that replace the plan's own, e.g.
/// played_pressures() for the score of the pressures as played.
Metrics score_plan(const TargetField& target, const Plan& plan, int patch, double sigma,
                   const GainLaw& gain, const SegmentPressures* instead = nullptr);

/// (Q1) of a plan with each cell's error weighted by its weight, √(Σ w (p̂ − p*)² / Σ w); 0 for a
/// target without pressure. @pre the target has weights, at least one > 0 on skin.
double weighted_rmse(const TargetField& target, const Plan& plan, int patch, double sigma,
                     const GainLaw& gain, const SegmentPressures* instead = nullptr);

/// One row of the controls' table: the metrics of a rendering that a plan must outperform.
struct Control {
  std::string name;
  Metrics metrics;
};

/// Returns the circles of the control "four circles at the mass centres" of controls(); an empty
/// plan for a target without pressure.
Plan circles_at_mass_centres(const TargetField& target, const GainLaw& gain, double length,
                             std::uint64_t seed);
/// Returns one circle about the centre of mass. Its radius is the mean distance of the pressure
/// from there, within the bounds of its length [m]; its pressure is that of
/// circles_at_mass_centres(). An empty plan for a target without pressure.
Plan circle_at_mean_distance(const TargetField& target, const GainLaw& gain, double least_length,
                             double most_length);
/// Returns one draw of the control "random circles, solved pressures"; an empty plan for a target
/// without pressure.
Plan random_circles(const TargetField& target, double sigma, const GainLaw& gain, double length,
                    Random& random);

/// Scores the controls of a target, which a plan must outperform; empty for a target without
/// pressure:
/// - "flat field": the mean p* everywhere (no path, so coverage 0);
/// - "four circles at the mass centres": one about each centre of a weighted 4-means, each `length`
///   long, p_i = γ times the mean p* of the points above 1 % of the maximum;
/// - "random circles, solved pressures": up to four circles `length` long about random skin cells
///   that do not cross, with the non-negative least-squares p_i; the median of each metric over 20
///   draws;
/// - "random foci, solved pressures", if `other` holds foci: as many at random skin cells, with the
///   pressures of (B3); the median of each metric over 20 draws;
/// - "paths of another target" or "foci of another target", if `other` is given and not empty: its
///   paths or foci, their mean moved to this target's centre of mass, their highest p_i/γ set to
///   max p*.
/// @param sigma fall-off of a focal point [m].  @param gain γ of each path; circles take a lap of
/// 1/draw_rate.  @param length length of a circle, e.g. L [m].  @param progress called after each
/// scored field, since a large raster takes seconds.
std::vector<Control> controls(const TargetField& target, double sigma, const GainLaw& gain,
                              double length, const Plan* other, std::uint64_t seed,
                              const std::function<void(int done, int all)>& progress = {});

}  // namespace prostm
