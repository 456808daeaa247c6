/// What the planners are worth: quality and speed of every preset on the gallery of bench/fields or
/// on captured fields, beside a textbook planner and controls.
///
/// usage: planner_bench [--json FILE] [--frames N] [--seeds N] [--figure FILE]
///                      [--scaling-figure FILE] [--bending-figure FILE] [FIELDS ...]

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>
#include <vector>

#include "figure/figures.hpp"
#include "planner/am.hpp"
#include "planner/bending.hpp"
#include "planner/budgets.hpp"
#include "planner/contenders.hpp"
#include "planner/nlopt_baseline.hpp"
#include "planner/on_skin.hpp"
#include "planner/picture.hpp"
#include "planner/power.hpp"
#include "planner/quality.hpp"
#include "planner/scaling.hpp"
#include "planner/sequences.hpp"
#include "planner/simultaneous.hpp"
#include "planner/steadiness.hpp"
#include "planner/vectors.hpp"
#include "planner/weights.hpp"
#include "report.hpp"

namespace prostm::bench {
namespace {

constexpr const char* kUsage =
    "usage: planner_bench [--json FILE] [--frames N] [--seeds N] [--vectors NAME]\n"
    "                     [--figure FILE] [--scaling-figure FILE] [--bending-figure FILE] [FIELDS "
    "...]\n"
    "  --frames N   scored of each field, spread over its sequence (20)\n"
    "  --seeds N    of the textbook planner, whose median counts (20)\n"
    "  --vectors NAME   no better vector instructions than these: AVX2, SSE4, …, none\n"
    "  --figure FILE, --scaling-figure FILE, --bending-figure FILE   draw the gallery, time "
    "against size, and error\n"
    "               against corners; .png or .svg\n"
    "FIELDS, recordings of prostm capture or field files, take the place of the generated "
    "fields.\n";

struct Options {
  std::string json, figure, scaling_figure, bending_figure;
  QualityOptions quality;
  std::vector<std::string> files;
};

int number(const char* option, const char* text, int low, int high) {
  int value = 0;
  const char* end = text + std::strlen(text);
  const auto [last, error] = std::from_chars(text, end, value);
  if (error != std::errc() || last != end || value < low || value > high) {
    throw InputError(
        fmt::format("{} {} must be a whole number between {} and {}", option, text, low, high));
  }
  return value;
}

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
    } else if (argument == "--scaling-figure") {
      options.scaling_figure = value;
    } else if (argument == "--bending-figure") {
      options.bending_figure = value;
    } else if (argument == "--frames") {
      options.quality.frames = number("--frames", value, 1, 10'000);
    } else if (argument == "--vectors") {
      limit_vectors(value);
    } else if (argument == "--seeds") {
      options.quality.seeds = number("--seeds", value, 1, 1000);
    } else {
      throw InputError("there is no option " + argument);
    }
  }
  for (const std::string& figure :
       {options.figure, options.scaling_figure, options.bending_figure}) {
    if (!figure.empty()) check_figure(figure);
  }
  return options;
}

std::vector<Row> measure_all(const Options& options) {
  std::vector<Sequence> sequences;
  for (const std::string& file : options.files) sequences.push_back(read_sequence(file));
  const std::vector<Sequence> generated = gallery();
  if (sequences.empty()) sequences = generated;

  std::vector<Contender> contenders = bench::contenders();
  std::vector<SequenceOutcome> outcomes;
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    // three patterns on, so that it is another kind of field
    const TargetField other = generated[(s + 3) % generated.size()].field(1);
    outcomes.push_back(measure(sequences[s], other, contenders, options.quality));
    print(outcomes.back());
  }
  print_summary(outcomes);
  std::vector<Row> rows;
  append_rows(outcomes, rows);
  measure_am(sequences, options.quality.frames, rows);
  if (!options.files.empty()) return rows;
  measure_budgets(rows);
  measure_steadiness(contenders, rows);
  measure_simultaneous(std::min(options.quality.frames, 10), rows);
  measure_on_skin(std::min(options.quality.frames, 5), rows);
  measure_weights(std::min(options.quality.frames, 10), rows);
  compare_with_nlopt(std::min(options.quality.frames, 10), rows);
  measure_bending(options.bending_figure, rows);
  measure_power(std::min(options.quality.frames, 10), rows);
  measure_scaling(options.scaling_figure, rows);
  if (!options.figure.empty()) draw_gallery_picture(options.figure);
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
    const std::vector<bench::Row> rows = bench::measure_all(options);
    fmt::print("\n");
    bench::print(rows);
    if (!options.json.empty()) write_file(options.json, bench::to_json(rows));
    return 0;
  } catch (const InputError& error) {
    fmt::print(stderr, "{}: {}\n{}", argv[0], error.what(), bench::kUsage);
    return 2;
  }
}
