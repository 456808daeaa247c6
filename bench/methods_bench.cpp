/// Ways to render a target, played by the array and felt by the skin, under three controls.
///
/// usage: methods_bench [--json FILE] [--frames N] [--figure F.png]

#include <fmt/core.h>

#include <charconv>
#include <cstring>
#include <string>

#include "figure/figures.hpp"
#include "methods/comparison.hpp"

namespace prostm::bench {
namespace {

constexpr const char* kUsage =
    "usage: methods_bench [--json FILE] [--frames N] [--figure F.png]\n"
    "  --frames N      frames of each generated sequence, 1 to 100 (default 3)\n"
    "  --figure FILE   draw what each way puts on the skin, and what is felt\n";

struct Options {
  std::string json, figure;
  int frames = 3;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument != "--json" && argument != "--figure" && argument != "--frames") {
      throw InputError("there is no option " + argument);
    }
    if (i + 1 == argc) throw InputError(argument + " needs a value");
    const char* value = argv[++i];
    if (argument == "--json") {
      options.json = value;
    } else if (argument == "--figure") {
      options.figure = value;
    } else {
      const char* end = value + std::strlen(value);
      const auto parsed = std::from_chars(value, end, options.frames);
      if (parsed.ec != std::errc() || parsed.ptr != end || options.frames < 1 ||
          options.frames > 100) {
        throw InputError(
            fmt::format("--frames {} must be a whole number between 1 and 100", value));
      }
    }
  }
  if (!options.figure.empty()) check_figure(options.figure);
  return options;
}

}  // namespace
}  // namespace prostm::bench

int main(int argc, char** argv) {
  using namespace prostm;
  if (argc == 2 && std::strcmp(argv[1], "--help") == 0) {
    fmt::print("{}", bench::kUsage);
    return 0;
  }
  try {
    const bench::Options options = bench::parse(argc, argv);
    std::vector<bench::Row> rows;
    bench::compare_ways(options.frames, rows);
    if (!options.figure.empty()) bench::draw_ways(options.figure);
    fmt::print("\n");
    bench::print(rows);
    if (!options.json.empty()) write_file(options.json, bench::to_json(rows));
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n{}", argv[0], error.what(), bench::kUsage);
    return 2;
  }
}
