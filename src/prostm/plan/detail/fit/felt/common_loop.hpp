#pragma once
/// The common loop of all paths of a plan in step.

#include <array>
#include <span>

#include "prostm/plan/plan.hpp"

namespace prostm::planning {

/// Number of laps of each path in a loop.
using LapCounts = std::array<int, kMaxPaths>;

/// A loop, and the number of laps of each path in it.
struct CommonLoop {
  double period = 0.0;  ///< [s]
  LapCounts laps{};
  double pace = 1.0;  ///< speed of the focal points over their own speed, mean over paths
};

/// Chooses the loop in which focal points move closest to their own (maximum) speed, (P22): of the
/// periods from longest/2 to `longest`, in steps of longest/20, the one with the largest Σ (speed
/// over own speed)². @param own lap time of each path at its own speed [s], at most `longest`.
/// @param before period of the previous plan's loop, kept unless another gains 10 %; 0: none.
CommonLoop choose_loop(std::span<const double> own, double longest, double before);
/// Returns the loop of a given period. @pre no lap time in `own` exceeds the period.
CommonLoop loop_of(std::span<const double> own, double period);

}  // namespace prostm::planning
