#pragma once
/// Whether plans keep to their budget of time.

#include <vector>

#include "report.hpp"

namespace prostm::bench {

/// Times plans of `best` on the generated fields under budgets of 1 and 20 ms, each in turn with a
/// loop that does nothing but watch the clock until 97 % of the budget: what that loop is late,
/// the machine is. Prints the table.
void measure_budgets(std::vector<Row>& rows);

}  // namespace prostm::bench
