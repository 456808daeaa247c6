#include "methods/tables.hpp"

#include <fmt/format.h>

#include <array>

#include "prostm/core/input_error.hpp"

namespace prostm::bench {

using namespace methods;

namespace {

double mean(const Distribution& d) {
  return d.summary().mean;
}

void print_model(const std::array<Means, kWays.size()>& means) {
  fmt::print("\nBy Eq. (1), with the paper's width\n{:<16} {:>8} {:>8} {:>8} {:>8}\n", "", "RMSE",
             "corr.", "S_0", "overlap");
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means& m = means[w];
    if (kWays[w] == Way::Flat) continue;
    fmt::print("{:<16} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f}\n", to_string(kWays[w]), mean(m.rmse),
               mean(m.correlation), mean(m.model_skill), mean(m.model_overlap));
  }
}

void print_shapes(const std::array<Means, kWays.size()>& means) {
  fmt::print(
      "\nShapes, independent of the level. Envelope: largest radiation pressure over the loop; "
      "felt: "
      "the\n"
      "map of perceived intensity; lobe: largest of the envelope more than {:.0f} mm from all "
      "paths, "
      "over\nits largest; ghosts: maxima of the percept above half of its largest where nothing "
      "is "
      "to be felt,\nand the strongest of all such maxima over the largest\n"
      "{:<16} {:>8} {:>8} {:>8} {:>8} {:>8} | {:>8} {:>8} {:>8} {:>8} {:>8} {:>9}\n",
      1e3 * kBesidePaths, "", "S_0", "S_8.5", "overlap", "spill", "lobe", "felt S8.5", "corr.",
      "overlap", "spill", "ghosts", "strongest");
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    const Means& m = means[w];
    fmt::print(
        "{:<16} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} | {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} "
        "{:>8.2f} {:>9.3f}\n",
        to_string(kWays[w]), mean(m.skill_0), mean(m.skill_8), mean(m.overlap), mean(m.spill),
        mean(m.side_lobe), mean(m.felt_skill_8), mean(m.felt_correlation), mean(m.felt_overlap),
        mean(m.felt_spill), mean(m.ghosts), mean(m.ghost));
  }
}

void print_levels(const std::array<Means, kWays.size()>& means) {
  constexpr std::array kControls = {"equal largest drive, |q| = 1",
                                    "equal mean power, that of best",
                                    "equal largest percept, that of best"};
  for (std::size_t c = 0; c < kControls.size(); ++c) {
    fmt::print("\nLevels, {}\n{:<16} {:>14} {:>12} {:>14} {:>14} {:>14}\n", kControls[c], "",
               "pressure, Pa", "lobe, Pa", "percept, um", "sqrt E, um", "ghost, um");
    for (std::size_t w = 0; w < kWays.size(); ++w) {
      const Means::Level& level = means[w].level[c];
      if (level.pressure.count() == 0) continue;
      fmt::print("{:<16} {:>14.2f} {:>12.2f} {:>14.3f} {:>14.3f} {:>14.3f}\n", to_string(kWays[w]),
                 mean(level.pressure), mean(level.lobe), mean(level.percept), mean(level.intensity),
                 mean(level.ghost));
    }
  }
}

}  // namespace

void compare_ways(const Targets& targets, std::vector<Row>& rows) {
  Renderer renderer(usx_array(), targets.at(0));
  std::array<Means, kWays.size()> means;
  for (const TargetField& target : targets) {
    const std::vector<Rendering> renderings = render_ways(renderer, target);
    if (renderings.empty())
      throw InputError("a plan's loop is too long for its percept to be computed");
    add_ways(renderings, means);
  }
  print_model(means);
  print_shapes(means);
  print_levels(means);
  for (std::size_t w = 0; w < kWays.size(); ++w) {
    if (kWays[w] == Way::Best) continue;
    rows.push_back({"methods/best/1 - S_8.5 of the envelope", "", means[1].lack.summary(),
                    to_string(kWays[w]), means[w].lack.summary().p50});
    rows.push_back({"methods/best/1 - S_8.5 of what is felt", "", means[1].felt_lack.summary(),
                    to_string(kWays[w]), means[w].felt_lack.summary().p50});
  }
}

}  // namespace prostm::bench
