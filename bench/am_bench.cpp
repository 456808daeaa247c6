/// The AM baseline: updates a second, Table I of [B-1] in trend, and the paper's Fig. 3 in kind.
///
/// usage: am_bench [--json FILE] [--frames N] [--figure FILE] [FIELDS ...]

#include <fmt/core.h>

#include <charconv>
#include <cstring>
#include <string>
#include <vector>

#include "figure/figures.hpp"
#include "planner/am.hpp"
#include "report.hpp"

namespace prostm::bench {
namespace {

constexpr const char* kUsage =
    "usage: am_bench [--json FILE] [--frames N] [--figure FILE] [FIELDS ...]\n"
    "  --frames N      scored of each field, spread over its sequence (20)\n"
    "  --figure FILE   draw target, STM and AM of each of FIELDS; .png or .svg\n"
    "FIELDS, recordings of prostm capture or field files, come after the generated fields.\n";

struct Options {
  std::string json, figure;
  int frames = 20;
  std::vector<std::string> files;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) != 0) {
      options.files.push_back(argument);
      continue;
    }
    if (i + 1 == argc) throw InputError(argument + " needs a value");
    const char* value = argv[++i];
    if (argument == "--json") {
      options.json = value;
    } else if (argument == "--figure") {
      options.figure = value;
    } else if (argument == "--frames") {
      const char* end = value + std::strlen(value);
      const auto [last, error] = std::from_chars(value, end, options.frames);
      if (error != std::errc() || last != end || options.frames < 1 || options.frames > 10'000) {
        throw InputError(
            fmt::format("--frames {} must be a whole number between 1 and 10000", value));
      }
    } else {
      throw InputError("there is no option " + argument);
    }
  }
  if (!options.figure.empty()) {
    check_figure(options.figure);
    if (options.files.empty()) throw InputError("--figure needs recordings to draw from");
  }
  return options;
}

std::vector<Row> measure(const Options& options) {
  std::vector<Sequence> captured;
  for (const std::string& file : options.files) captured.push_back(read_sequence(file));
  std::vector<Sequence> sequences = gallery();
  for (Sequence sequence : captured) {
    sequence.name = "captured " + sequence.name;
    sequences.push_back(sequence);
  }
  std::vector<Row> rows;
  measure_am(sequences, options.frames, rows);
  measure_am_table(sequences, options.frames, rows);
  if (!options.figure.empty()) draw_am_picture(captured, options.figure);
  return rows;
}

}  // namespace
}  // namespace prostm::bench

int main(int argc, char** argv) {
  using namespace prostm;
  try {
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
      fmt::print("{}", bench::kUsage);
      return 0;
    }
    const bench::Options options = bench::parse(argc, argv);
    const std::vector<bench::Row> rows = bench::measure(options);
    if (!options.json.empty()) write_file(options.json, bench::to_json(rows));
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n{}", argv[0], error.what(), bench::kUsage);
    return 2;
  }
}
