#pragma once
/// Checks whether plans keep to their time budget.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Times plans of `best` on the generated fields under budgets of 1 and 20 ms, in turn with a loop
/// that only watches the clock until 97 % of the budget: if that loop is late, the machine is the
/// cause. Prints the table.
void measure_budgets(std::vector<Row>& rows);

}  // namespace prostm::bench
