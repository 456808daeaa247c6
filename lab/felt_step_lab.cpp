/// The empirical numbers of the felt step, each halved and doubled.

#include "felt_step/tuning.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  bench::Program program("the numbers of the felt step, each halved and doubled");
  int fields = 96, fields_with_points = 12;
  program.option("--fields", fields, "number of fields whose pressures are chosen", 1, 100'000);
  program.option("--point-fields", fields_with_points, "number of fields on which points move, too",
                 1, 100'000);
  return program.run(argc, argv, [&] {
    std::vector<bench::Row> rows;
    bench::compare_tunings(fields, false, rows);
    bench::compare_tunings(fields_with_points, true, rows);
    return rows;
  });
}
