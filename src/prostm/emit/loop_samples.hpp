#pragma once
/// A plan in its steady state: samples of one loop that all paths share.

#include <vector>

#include "prostm/emit/emitter.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "prostm/emit/played_plan.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm {

/// Samples of one loop, after which all focal points of a plan are back at their starts.
struct LoopSamples {
  int foci = 0;     ///< one for each path or focus
  int samples = 0;  ///< of the loop
  double sample_rate = 0.0;
  std::vector<FocusSample> sample;  ///< sample-major: [k·foci + f]
  std::vector<int> laps;            ///< laps of each focal point in the loop; 0 at rest
  /// Relative difference of each lap's time from the planned one; negative: shorter.
  std::vector<double> stretch;
  PlayedPlan played;  ///< the plan as PathEmitter plays it; without paths for foci

  double largest_stretch() const;  ///< in magnitude; 0 without foci
};

/// Returns the samples of a plan in its steady state, as PathEmitter plays it, each path from its
/// first point. The periods of played_plan() are adjusted so that all paths play whole laps in one
/// loop, (E7). Its length is a multiple of kLoopUnit samples, from one to eight of the longest
/// laps: the shortest in which no lap changes by more than 1 %, or else the one with the least
/// change. A plan in step has its own loop, (E10), rounded to a multiple of kLoopUnit samples. A
/// plan of foci is played as FocusEmitter does once all are audible, for the fewest whole periods
/// of the modulation, (B4), that are a multiple of kLoopUnit samples.
/// @param plan its paths are measured, with finite numbers. A path without length or speed is a
/// focal point at rest, a path without points is silent.
/// @throws as validate(settings, sample_rate) does, and std::invalid_argument for a plan without
/// paths or foci, with more than settings.foci, with a loop out of bounds, or with a lap that takes
/// more than a second.
LoopSamples loop_samples(const LiftedPlan& plan, const EmitSettings& settings, double sample_rate);

/// Returns the time of the longest lap of a plan as it is played [s]; 0 if every focal point is at
/// rest. @pre is_loop(plan.loop).
double longest_lap(const LiftedPlan& plan, double sample_rate = 40e3);

/// Loops can be cut in parts of this many samples, 0.2 ms at 40 kHz.
inline constexpr int kLoopUnit = 8;

}  // namespace prostm
