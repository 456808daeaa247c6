/// Compares ways to render a target, played by the array and felt by the skin, under three
/// controls.

#include "methods/tables.hpp"
#include "program.hpp"
#include "prostm/figure/figures.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  bench::Program program("ways to render a target, played by the array and felt by the skin");
  int frames = 3;
  std::string figure, recording;
  program.option("--frames", frames, "frames of each generated sequence, or of the recording", 1,
                 100);
  program.option("--recording", recording,
                 "compare on frames of a recording's second half instead of generated fields");
  program.option("--figure", figure, "draw each way's pressure on the skin, and its percept");
  return program.run(argc, argv, [&] {
    if (!figure.empty()) check_figure(figure);
    std::vector<bench::Row> rows;
    bench::compare_ways(recording.empty() ? methods::generated_targets(frames)
                                          : methods::recorded_targets(recording, frames),
                        rows);
    if (!figure.empty()) methods::draw_ways(figure);
    return rows;
  });
}
