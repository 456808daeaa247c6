#pragma once
/// Charts of felt shape against felt strength.

#include <vector>

#include "felt/tables.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::bench {

/// Returns a chart for each set: lack over strength of each way, means over the fields relative to
/// the first way. Ways whose names agree up to their last ", " are one line; the next word labels
/// the point. @pre each set has a field and a way.
std::vector<Chart> front_charts(const std::vector<JudgedSet>& sets);

}  // namespace prostm::bench
