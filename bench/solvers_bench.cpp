/// Focus solvers: solutions per second, accuracy, and steps of the drives' phases.
///
/// usage: solvers_bench [--json FILE]

#include "report.hpp"
#include "solvers/solver_tables.hpp"

int main(int argc, char** argv) {
  using namespace prostm::bench;
  return run(argc, argv, [] {
    std::vector<Row> rows;
    measure_speed(rows);
    measure_streams(rows);
    print_power_and_rounding();
    print_random_sets(1000);
    return rows;
  });
}
