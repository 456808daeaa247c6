#pragma once
/// Shared parts of the benchmark programs: their common option, table and JSON.

#include <fmt/format.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "prostm/core/distribution.hpp"
#include "prostm/core/input_error.hpp"

namespace prostm::bench {

/// One line of a table: a distribution, and the median of its baseline.
struct Row {
  std::string name, unit;
  Summary ours;
  std::string baseline;       ///< empty without a comparison
  double baseline_p50 = 0.0;  ///< in `unit`
};

void print(const std::vector<Row>& rows);

/// Returns [{"name","unit","n","p50","p99","max","baseline","baseline_p50","ratio"}, …]; ratio is
/// baseline over ours.
std::string to_json(const std::vector<Row>& rows);

/// Prints rows and writes them to the file `json`, if it is named. @return 0
int print_and_write(const std::vector<Row>& rows, const std::string& json);

/// The main() of a benchmark: `program [--json FILE]`; `measure` returns the rows.
int run(int argc, char** argv, const std::function<std::vector<Row>()>& measure);

}  // namespace prostm::bench
