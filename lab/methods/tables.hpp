#pragma once
/// Tables that compare the ways to render a target.

#include <vector>

#include "prostm/methods/comparison.hpp"
#include "report.hpp"

namespace prostm::bench {

/// Renders targets in every way with the USX-like array, and prints means: first the quantities
/// that do not depend on the level, then pressures and percepts under each control.
void compare_ways(const methods::Targets& targets, std::vector<Row>& rows);

}  // namespace prostm::bench
