#include "report.hpp"

#include <cstring>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/text/json.hpp"

namespace prostm::bench {

void print(const std::vector<Row>& rows) {
  fmt::print("{:<44} {:>6} {:>10} {:>10} {:>10}   {}\n", "", "unit", "p50", "p99", "max",
             "against (p50, ratio)");
  for (const Row& row : rows) {
    fmt::print("{:<44} {:>6} {:>10.4g} {:>10.4g} {:>10.4g}", row.name, row.unit, row.ours.p50,
               row.ours.p99, row.ours.max);
    if (!row.baseline.empty()) {
      fmt::print("   {} ({:.4g}, {:.2f})", row.baseline, row.baseline_p50,
                 row.baseline_p50 / row.ours.p50);
    }
    fmt::print("\n");
  }
}

std::string to_json(const std::vector<Row>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    nlohmann::ordered_json one = {
        {"name", row.name},    {"unit", row.unit},        {"n", row.ours.n},
        {"p50", row.ours.p50}, {"p99", row.ours.p99},     {"max", row.ours.max},
        {"baseline", nullptr}, {"baseline_p50", nullptr}, {"ratio", nullptr}};
    if (!row.baseline.empty()) {
      one["baseline"] = row.baseline;
      one["baseline_p50"] = row.baseline_p50;
      if (row.ours.p50 > 0.0) one["ratio"] = row.baseline_p50 / row.ours.p50;
    }
    list.push_back(one);
  }
  return prostm::to_text(list);
}

int print_and_write(const std::vector<Row>& rows, const std::string& json) {
  fmt::print("\n");
  print(rows);
  if (!json.empty()) write_file(json, to_json(rows));
  return 0;
}

int run(int argc, char** argv, const std::function<std::vector<Row>()>& measure) {
  std::string json;
  if (argc == 3 && std::strcmp(argv[1], "--json") == 0) {
    json = argv[2];
  } else if (argc != 1) {
    fmt::print(stderr, "{}: the only option is --json FILE\n", argv[0]);
    return 2;
  }
  try {
    return print_and_write(measure(), json);
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
    return 2;
  }
}

}  // namespace prostm::bench
