/// Measures the scenes' pressure on held hands, for comparison with the paper's Fig. 3.

#include "plumes/plumes.hpp"
#include "plumes/refinement.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  using namespace prostm;
  bench::Program program("the scenes' pressure on held hands");
  std::string folder, only, curves;
  std::vector<std::string> scenes = {"four-plumes", "one-plume", "two-plumes", "three-plumes"};
  std::vector<int> cells = {64};
  std::vector<double> steps = {20};
  double width = 1e3 * FluidSettings().width, theta = FluidSettings().theta;
  int substeps = FluidSettings().substeps;
  std::string follow;
  std::string part(name_of(PressurePart::All));
  int frames = 250;
  double trim = JetSettings().trim_rate, tremor = 4.0;
  program.option("--hands", folder, "folder with recorded hands");
  program.option("--tremor-above", tremor,
                 "use the recorded tremor above this frequency [Hz]; 0: none", 0.0, 50.0);
  program.option("--only", only, "cases whose name contains this");
  program.option("--scenes", scenes, "scenes");
  program.option("--cells", cells, "cells along each edge");
  program.option("--steps", steps, "steps [ms]");
  program.option("--width", width, "edge of the box [mm]");
  program.option("--theta", theta, "weight of the pressure at the end of a path");
  program.option("--substeps", substeps, "fluid steps per step");
  program.option("--follow", follow, "what the box follows: palm or index");
  program.option("--pressure-of", part, "pressure to use: all, smoke or movement");
  program.option("--trim", trim, "rate of the jets' trim [1/s]");
  program.option("--frames", frames, "frames of each case", 1, 2000);
  program.option("--curves", curves, "draw only the curves of refinement, into this picture");
  return program.run(argc, argv, [&] {
    std::vector<bench::Row> rows;
    if (!curves.empty()) {
      bench::draw_refinement(curves);
      return rows;
    }
    for (const std::string& scene : scenes) {
      for (const bench::HeldCase& held : bench::held_cases(folder, tremor)) {
        if (held.name.find(only) == std::string::npos) continue;
        for (const int n : cells) {
          for (const double ms : steps) {
            PipelineSettings settings;
            settings.scene = scene;
            settings.fluid.cells = n;
            settings.fluid.width = 1e-3 * width;
            settings.fluid.theta = theta;
            settings.fluid.substeps = substeps;
            if (!follow.empty()) settings.box.follow = from_name<BoxFollows>(follow, "follow");
            settings.fluid_pressure.part = from_name<PressurePart>(part, "pressure-of");
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
