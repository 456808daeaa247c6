#pragma once
/// The paper's costs given to another minimiser.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Minimises (P6) from the starting paths of preset paper with the planner's own descent, as many
/// steps as the preset takes and until it gains no more, and with the L-BFGS of NLopt to
/// convergence, on frames of the nine fields. Prints (ours − theirs)/|theirs| of the final costs.
/// Says so where the bench was built without NLopt.
void compare_with_nlopt(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
