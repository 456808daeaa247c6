#include "plumes/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "plumes/plumes.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::bench {
namespace {

constexpr int kFrames = 25;
constexpr double kSteps[] = {0.020, 0.010, 0.005};  // [s]
constexpr double kThetas[] = {1.0, 0.6};

const HeldCase& named(const std::vector<HeldCase>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(),
                       [&](const HeldCase& held) { return held.name == name; });
}

/// Adds a line for each θ and step. @param value returns a result, one for each chart.
void add_lines(const HeldCase& held, const PipelineSettings& base, const std::vector<int>& grids,
               const std::vector<std::function<double(const Measured&)>>& value, Chart* charts) {
  for (const double theta : kThetas) {
    for (const double step : kSteps) {
      const std::string name = fmt::format("θ {}, {:.0f} ms", theta, 1e3 * step);
      std::vector<ChartSeries> lines(value.size(), {name, {}, {}});
      for (const int cells : grids) {
        PipelineSettings settings = base;
        settings.scene = "four-plumes";
        settings.fluid.cells = cells;
        settings.fluid.theta = theta;
        const Measured measured = measure_plumes(held, settings, step, kFrames);
        for (std::size_t chart = 0; chart < value.size(); ++chart) {
          lines[chart].x.push_back(1e3 * settings.fluid.width / cells);
          lines[chart].y.push_back(value[chart](measured));
        }
        fmt::print("{}, {}³, {}\n", held.name, cells, name);
        std::fflush(stdout);
      }
      for (std::size_t chart = 0; chart < value.size(); ++chart)
        charts[chart].series.push_back(lines[chart]);
    }
  }
}

}  // namespace

void draw_refinement(const std::string& path) {
  const std::vector<HeldCase> cases = held_cases("");
  const auto chart = [](const char* title, const char* y) {
    return Chart{title, "edge of a cell / mm", y, false, {}, false};
  };
  std::vector<Chart> charts = {chart("Pad of a finger, box of 0.12 m", "force / mN"),
                               chart("Palm, box of 0.36 m", "area above half / cm²"),
                               chart("Palm, box of 0.36 m", "force / mN")};
  PipelineSettings finger;
  finger.fluid.width = 0.12;
  finger.box.follow = BoxFollows::Index;
  finger.jets.trim_rate = 0.0;
  add_lines(named(cases, "finger over a jet"), finger, {32, 48, 64, 80, 96},
            {[](const Measured& m) { return m.pad.summary().mean; }}, charts.data());
  add_lines(named(cases, "study hand 1.0"), {}, {48, 64, 96},
            {[](const Measured& m) { return 1e4 * m.frames.back().area; },
             [](const Measured& m) { return 1e3 * m.frames.back().force; }},
            charts.data() + 1);
  draw_charts(charts, path);
}

}  // namespace prostm::bench
