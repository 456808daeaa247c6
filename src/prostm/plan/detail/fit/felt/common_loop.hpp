#pragma once
/// One loop for all paths of a plan in step.

#include <array>
#include <span>

#include "prostm/plan/plan.hpp"

namespace prostm::planning {

/// Laps of each path in a loop.
using LapCounts = std::array<int, kMaxPaths>;

/// A loop, and the laps that each path makes in it.
struct CommonLoop {
  double period = 0.0;  ///< [s]
  LapCounts laps{};
  double pace = 1.0;  ///< speed of the focal points over their own, the mean over paths
};

/// Chooses the loop in which focal points move nearly as fast as they may, (P22): of the periods
/// from half of `longest` up, in steps of a twentieth, the one with the largest Σ (speed over
/// own speed)². @param own time of a lap of each path at its own speed [s], at most `longest`.
/// @param before period of the last plan's loop, which is kept unless others gain 10 %; 0: none.
CommonLoop choose_loop(std::span<const double> own, double longest, double before);
/// Returns the loop of a given period. @pre no path's own lap is longer.
CommonLoop loop_of(std::span<const double> own, double period);

}  // namespace prostm::planning
