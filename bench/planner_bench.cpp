/// Quality and speed of every preset on the generated gallery of src/prostm/fields or on captured
/// fields, compared with a textbook planner and controls.

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "planner/am.hpp"
#include "planner/bending.hpp"
#include "planner/budgets.hpp"
#include "planner/contenders.hpp"
#include "planner/nlopt_baseline.hpp"
#include "planner/on_skin.hpp"
#include "planner/power.hpp"
#include "planner/quality.hpp"
#include "planner/scaling.hpp"
#include "planner/sequences.hpp"
#include "planner/simultaneous.hpp"
#include "planner/steadiness.hpp"
#include "planner/vectors.hpp"
#include "planner/weights.hpp"
#include "program.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::bench {
namespace {

struct Options {
  std::string vectors, scaling_figure, bending_figure;
  QualityOptions quality;
  std::vector<std::string> files;
};

std::vector<Row> measure_all(const Options& options) {
  if (!options.vectors.empty()) limit_vectors(options.vectors);
  for (const std::string& figure : {options.scaling_figure, options.bending_figure}) {
    if (!figure.empty()) check_figure(figure);
  }
  std::vector<Sequence> sequences;
  for (const std::string& file : options.files) sequences.push_back(read_sequence(file));
  const std::vector<Sequence> generated = gallery();
  if (sequences.empty()) sequences = generated;

  std::vector<Contender> contenders = bench::contenders();
  std::vector<SequenceOutcome> outcomes;
  for (std::size_t s = 0; s < sequences.size(); ++s) {
    // three patterns further on, so that the field is of another kind
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
  return rows;
}

}  // namespace
}  // namespace prostm::bench

int main(int argc, char** argv) {
  using namespace prostm::bench;
  Program program(
      "every preset on generated or given fields, beside a textbook planner and controls");
  Options options;
  program.option("--frames", options.quality.frames,
                 "frames scored per field, spread over its sequence", 1, 10'000);
  program.option("--seeds", options.quality.seeds,
                 "seeds of the textbook planner; the median counts", 1, 1000);
  program.option("--vectors", options.vectors,
                 "best vector instructions to use: AVX2, SSE4, …, none");
  program.option("--scaling-figure", options.scaling_figure, "draw time against size");
  program.option("--bending-figure", options.bending_figure, "draw error against corners");
  program.option("FIELDS", options.files,
                 "recordings of prostm capture or field files, in place of the generated fields");
  return program.run(argc, argv, [&] { return measure_all(options); });
}
