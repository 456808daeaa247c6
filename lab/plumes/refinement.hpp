#pragma once
/// Dependence of the pressure on a palm and a finger on cells and steps.

#include <string>

namespace prostm::bench {

/// Measures four plumes over grids, steps and θ, and draws curves over the edge of a cell: the
/// force on the pad of a finger over a jet, in a box of 0.16 m that follows it, and the area above
/// half of the largest pressure and the force on a study hand, in the default box. Takes some ten
/// minutes.
void draw_refinement(const std::string& path);

}  // namespace prostm::bench
