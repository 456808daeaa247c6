#pragma once
/// Compares the presets' minimisers with another one.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Minimises (P6) from the starting paths of preset paper, and (P11)–(P15) from starts of preset
/// best, on frames of the nine fields. Each minimum is found by the planner's own descent, with as
/// many steps as the preset takes and until it gains no more, and by the L-BFGS of NLopt, to
/// convergence. Prints (ours − theirs)/|theirs| of the final costs, or a message if this build has
/// no NLopt.
void compare_with_nlopt(int frames, std::vector<Row>& rows);

}  // namespace prostm::bench
