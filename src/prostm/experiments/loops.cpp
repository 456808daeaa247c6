/// Perceived intensity of a loop by length and speed: the gain that equalises all lengths, and the
/// speed that is perceived as strongest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/core/units.hpp"
#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::experiments {
namespace {

/// Returns the mean of a map along a lap, linear between cells.
double along(const Lap& lap, const Palm& palm, const std::vector<double>& map) {
  constexpr int kPlaces = 128;
  const SkinPatch& patch = palm.patch;
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec2 at = (lap(static_cast<double>(i) / kPlaces) - palm.at(0, 0)) / patch.cell;
    const int col = static_cast<int>(at.x()), row = static_cast<int>(at.y());
    const double x = at.x() - col, y = at.y() - row;
    const double* here = &map[static_cast<std::size_t>(row * patch.cols + col)];
    const double* next = here + patch.cols;
    sum +=
        (1.0 - y) * ((1.0 - x) * here[0] + x * here[1]) + y * ((1.0 - x) * next[0] + x * next[1]);
  }
  return sum / kPlaces;
}

Chart gain_chart(const LoopTable& table) {
  Chart chart{fmt::format("Gain at {:.0f} m/s that equalises loops", kUsualSpeed),
              "period / ms",
              "gain",
              false,
              {},
              false};
  const auto add = [&](const std::string& name, const std::vector<double>& gains) {
    ChartSeries series{name, {}, gains};
    for (const double length : table.lengths) series.x.push_back(1e3 * length / kUsualSpeed);
    chart.series.push_back(series);
  };
  const auto of = [&](std::size_t skin, double LoopStrength::*strength) {
    std::vector<double> gains = relative_gains(table, skin, strength);
    for (double& gain : gains) gain *= kLongestGain;
    return gains;
  };
  const std::size_t nominal = table.skins.size() / 2;
  for (std::size_t s = 0; s < table.skins.size(); ++s) {
    if (table.settings[s].loss != table.settings[nominal].loss) continue;
    add(fmt::format("along the loop, waves of {:.0f} m/s", table.settings[s].fast_speed),
        of(s, &LoopStrength::along));
  }
  add(fmt::format("whole loop, {:.0f} m/s", table.settings[nominal].fast_speed),
      of(nominal, &LoopStrength::intensity));
  std::vector<double> roots;
  for (const double length : table.lengths)
    roots.push_back(kLongestGain * std::sqrt(length / table.lengths.back()));
  add("exponent 1/2", roots);
  return chart;
}

Chart speed_chart(const LoopTable& table) {
  Chart chart{"Strength along a loop",
              "speed of the focal point / (m/s)",
              "equivalent displacement at 250 Hz / µm rms",
              false,
              {},
              false};
  for (std::size_t l = 0; l < table.lengths.size(); l += 2) {
    ChartSeries series{fmt::format("{:.0f} mm", 1e3 * table.lengths[l]), table.speeds, {}};
    for (const LoopStrength& here : table.nominal()[l]) series.y.push_back(1e6 * here.along);
    chart.series.push_back(series);
  }
  return chart;
}

}  // namespace

LoopTable loop_table(std::span<const double> lengths, std::span<const double> speeds, Skins skins,
                     const Step& step) {
  const Palm palm;
  const StmField field(usx_array(), palm);
  std::vector<SkinResponse> responses;
  for (const SkinSettings& settings : skins) {
    responses.emplace_back(SkinModel(settings), palm.patch);
  }
  LoopTable out{{lengths.begin(), lengths.end()},
                {speeds.begin(), speeds.end()},
                {skins.begin(), skins.end()},
                {}};
  out.skins.resize(skins.size(), SkinLoops(lengths.size()));
  std::vector<double> map(palm.cells());
  for (std::size_t l = 0; l < lengths.size(); ++l) {
    const Lap lap = circle_lap(lengths[l]);
    for (const double speed : speeds) {
      const double period = lengths[l] / speed;
      const std::vector<double> pressure = field.pressure(lap, period, false);
      for (std::size_t s = 0; s < skins.size(); ++s) {
        responses[s].prepare(period, StmField::kSamples);
        responses[s].respond({period, StmField::kSamples, pressure});
        percept_map(responses[s], map);
        out.skins[s][l].push_back({along(lap, palm, map), perceived_intensity(responses[s])});
      }
      step();
    }
  }
  return out;
}

std::size_t LoopTable::usual_speed() const {
  return static_cast<std::size_t>(std::ranges::find(speeds, kUsualSpeed) - speeds.begin());
}

std::vector<double> relative_gains(const LoopTable& table, std::size_t skin,
                                   double LoopStrength::*strength) {
  const std::size_t usual = table.usual_speed();
  const SkinLoops& loops = table.skins[skin];
  std::vector<double> out;
  for (const auto& of_length : loops)
    out.push_back(loops.back()[usual].*strength / (of_length[usual].*strength));
  return out;
}

double strongest_speed(const LoopTable& table, std::size_t skin, std::size_t length,
                       double LoopStrength::*strength) {
  const std::vector<LoopStrength>& by_speed = table.skins[skin][length];
  const auto most =
      std::ranges::max_element(by_speed, {}, [&](const LoopStrength& of) { return of.*strength; });
  return table.speeds[static_cast<std::size_t>(most - by_speed.begin())];
}

void draw_loops(const LoopTable& table, const std::string& path) {
  draw_charts({gain_chart(table), speed_chart(table)}, path);
}

}  // namespace prostm::experiments
