#pragma once
/// The benefit of weights where they are large, and their cost elsewhere.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Prints, for preset best on every generated field with the upper half of its rows weighed four
/// times, the RMSE over the skin of each half beside that of the plan without weights.
/// @param frames number of frames per pattern.
void measure_weights(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
