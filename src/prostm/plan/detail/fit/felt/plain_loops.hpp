#pragma once
/// A circle and a line through the pressure of a target: single paths to start from.

#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::planning {

/// Bounds of the loops [mm].
struct LoopBounds {
  double least_length, most_length;
  double width;  ///< of the loop that traces a line there and back
};

/// Sets `loops` to a circle about the centroid of the pressure, with the pressure's mean distance
/// from there as its radius. Coordinates are relative to the target's origin [mm].
/// @pre some pressure is above 0. loops.samples is set.
void start_circle(const TargetField& target, const LoopBounds& bounds, Loops& loops);
/// Sets `loops` to a flat ellipse along the pressure's longest axis, as long as a uniform line with
/// the same variance.
void start_line(const TargetField& target, const LoopBounds& bounds, Loops& loops);

}  // namespace prostm::planning
