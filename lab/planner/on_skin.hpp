#pragma once
/// What uneven skin makes of plans.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Prints, for paper-valid and best on each of the generated skins, exact and in voxels, how far
/// the longest path is from L on the skin, and how fast and slow a focal point is that plays its
/// laps in the period length / speed of the plane.
/// @param frames of each pattern's sequence.
void measure_on_skin(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
