#pragma once
/// The effect of uneven skin on plans.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Prints, for paper-valid and best on each of the generated skins, exact and in voxels, the excess
/// of the longest path over L on the skin, and the speed on the skin of a focal point whose laps
/// take the period length / speed of the plane. @param frames number of frames per pattern.
void measure_on_skin(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
