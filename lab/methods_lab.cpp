/// Compares ways to render a target, played by the array and felt by the skin, under three
/// controls.

#include "methods/tables.hpp"
#include "program.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/methods/gallery.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  bench::Program program("ways to render a target, played by the array and felt by the skin");
  int frames = 3;
  std::string figure, gallery, recording;
  program.option("--frames", frames, "frames of each generated sequence, or of the recording", 1,
                 100);
  program.option("--recording", recording,
                 "compare on frames of a recording's second half instead of generated fields");
  program.option("--figure", figure, "draw each way's pressure on the skin, and its percept");
  program.option("--gallery", gallery, "draw nine targets and what is planned for them");
  return program.run(argc, argv, [&] {
    for (const std::string& path : {figure, gallery}) {
      if (!path.empty()) check_figure(path);
    }
    std::vector<bench::Row> rows;
    bench::compare_ways(recording.empty() ? methods::generated_targets(frames)
                                          : methods::recorded_targets(recording, frames),
                        rows);
    if (!figure.empty()) methods::draw_ways(figure);
    if (!gallery.empty())
      methods::draw_gallery_of_ways(
          methods::render_gallery(fields::kPatterns.size(), [](double) {}), gallery);
    return rows;
  });
}
