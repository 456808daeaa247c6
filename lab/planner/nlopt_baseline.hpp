#pragma once
/// What the presets minimise, given to another minimiser.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Minimises (P6) from the starting paths of preset paper, and (P11)–(P15) from starts of preset
/// best, with the planner's own descents, as many steps as the presets take and until they gain no
/// more, and with the L-BFGS of NLopt to convergence, on frames of the nine fields. Prints (ours −
/// theirs)/|theirs| of the final costs. Says so where the bench was built without NLopt.
void compare_with_nlopt(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
