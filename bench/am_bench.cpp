/// The AM baseline: updates per second, the trend of Table I of [B-1], and a figure like the
/// paper's Fig. 3.

#include <fmt/core.h>

#include <string>
#include <vector>

#include "planner/am.hpp"
#include "program.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::bench {
namespace {

struct Options {
  std::string figure;
  int frames = 20;
  std::vector<std::string> files;
};

std::vector<Row> measure(const Options& options) {
  if (!options.figure.empty()) {
    check_figure(options.figure);
    if (options.files.empty()) throw InputError("--figure needs recordings to draw from");
  }
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
  using namespace prostm::bench;
  Program program("AM, the paper's baseline: updates a second, and its table of errors");
  Options options;
  program.option("--frames", options.frames, "frames scored per field, spread over its sequence", 1,
                 10'000);
  program.option("--figure", options.figure,
                 "draw target, STM and AM for each of FIELDS; .png, .svg or .pdf");
  program.option("FIELDS", options.files,
                 "recordings of prostm capture or field files, after the generated fields");
  return program.run(argc, argv, [&] { return measure(options); });
}
