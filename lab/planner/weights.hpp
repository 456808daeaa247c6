#pragma once
/// What weights buy where they are greater, and cost where they are less.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Prints, for preset best on every generated field with the upper half of its rows weighed four
/// times, the RMSE over the skin of either half beside that of the plan without weights.
/// @param frames of each pattern's sequence.
void measure_weights(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
