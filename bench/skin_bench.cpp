/// What the skin does under moving focal points: published experiments, computed with parameters
/// that were fixed before, and the cost of a response.
///
/// usage: skin_bench [--json FILE] [--figures FOLDER]

#include <fmt/core.h>

#include <cstring>
#include <string>

#include "figure/figures.hpp"
#include "report.hpp"
#include "skin/experiments.hpp"

namespace prostm::bench {
namespace {

constexpr const char* kUsage =
    "usage: skin_bench [--json FILE] [--figures FOLDER]\n"
    "  --figures FOLDER   draw skin-circles.png, skin-squares.png, skin-lines.png and "
    "skin-gap.png\n";

struct Options {
  std::string json, figures;

  std::string figure(const char* name) const {
    return figures.empty() ? std::string() : figures + "/" + name;
  }
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument != "--json" && argument != "--figures") {
      throw InputError("there is no option " + argument);
    }
    if (i + 1 == argc) throw InputError(argument + " needs a value");
    (argument == "--json" ? options.json : options.figures) = argv[++i];
  }
  if (!options.figures.empty()) check_figure(options.figure("skin-circles.png"));
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
    bench::measure_response(rows);
    bench::compute_circles(options.figure("skin-circles.png"), rows);
    bench::compute_squares(options.figure("skin-squares.png"), rows);
    bench::compute_regimes(options.figure("skin-lines.png"), rows);
    bench::compute_gap(options.figure("skin-gap.png"), rows);
    fmt::print("\n");
    bench::print(rows);
    if (!options.json.empty()) write_file(options.json, bench::to_json(rows));
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n", argv[0], error.what());
    return 2;
  }
}
