#pragma once
/// Where a focal point that is silent begins its path, so that it keeps away from those that sound.

#include <span>

#include "prostm/emit/detail/focus_motion.hpp"

namespace prostm {

/// The path's first point, as a place.
PathPlace first_place(const LiftedPath& path);

/// The place on the path, of 32 at equal arcs, from which a focal point keeps the largest distance
/// (E6) from `others` over two laps, if they go on as they do; the first point of a path on which
/// it would rest.
/// @param motion of that focal point, for its lap on the path.
/// @pre the path has a point and is measured.
PathPlace place_apart(const LiftedPath& path, const FocusMotion& motion,
                      std::span<const FocusMotion* const> others);

}  // namespace prostm
