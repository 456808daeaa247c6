/// Measures what the scenes press on held hands, beside the numbers of the paper's Fig. 3.

#include "plumes/plumes.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  CLI::App app("what the scenes press on held hands");
  std::string folder, only;
  std::vector<std::string> scenes = {"four-plumes", "one-plume", "two-plumes", "three-plumes"};
  std::vector<int> cells = {64};
  std::vector<double> steps = {20};
  int frames = 250;
  double trim = JetSettings().trim_rate;
  app.add_option("--hands", folder, "folder with recorded hands");
  app.add_option("--only", only, "cases whose name contains this");
  app.add_option("--scenes", scenes, "scenes")->capture_default_str();
  app.add_option("--cells", cells, "cells along each edge")->capture_default_str();
  app.add_option("--steps", steps, "steps [ms]")->capture_default_str();
  app.add_option("--trim", trim, "rate of the jets' trim [1/s]")->capture_default_str();
  app.add_option("--frames", frames, "frames of each case")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  return bench::run(app, argc, argv, [&] {
    std::vector<bench::Row> rows;
    for (const std::string& scene : scenes) {
      for (const bench::HeldCase& held : bench::held_cases(folder)) {
        if (held.name.find(only) == std::string::npos) continue;
        for (const int n : cells) {
          for (const double ms : steps) {
            PipelineSettings settings;
            settings.scene = scene;
            settings.fluid.cells = n;
            settings.jets.trim_rate = trim;
            const auto measured = bench::measure_plumes(held, settings, 1e-3 * ms, frames);
            const std::string name = fmt::format("{}, {}, {}³, {} ms", scene, held.name, n, ms);
            fmt::print("{}: {:.0f} % pass. {}\n", name, 100.0 * measured.pass, measured.says);
            std::fflush(stdout);
            bench::add_rows(name, measured, scene_from_name(scene).stimulus.maxima, rows);
          }
        }
      }
    }
    return rows;
  });
}
