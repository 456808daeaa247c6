#pragma once
/// Time against problem size.

#include <string>
#include <vector>

#include "planner/contenders.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Measures the time of a plan against the number of target points, 10³ to 10⁵ by finer rasters of
/// one field, and against the number of paths, 1 to 8, for every preset and the textbook in turn.
/// Prints both tables; draws them to `figure` unless it is empty.
/// @throws InputError if it cannot be written.
void measure_scaling(const std::string& figure, std::vector<Row>& rows);

}  // namespace prostm::bench
