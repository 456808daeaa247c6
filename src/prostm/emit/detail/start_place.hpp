#pragma once
/// The place where a silent focal point begins its path, away from audible ones.

#include <span>

#include "prostm/emit/detail/focus_motion.hpp"

namespace prostm {

/// Returns the path's first point, as a place.
PathPlace first_place(const LiftedPath& path);

/// Returns the place on the path, of 32 at equal arcs, from which a focal point keeps the largest
/// distance (E6) from `others` over two laps, if those stay on their paths; the first point if it
/// would be at rest on the path.
/// @param motion motion of the focal point, for its lap on the path.
/// @pre the path has a point and is measured.
PathPlace place_apart(const LiftedPath& path, const FocusMotion& motion,
                      std::span<const FocusMotion* const> others);

}  // namespace prostm
