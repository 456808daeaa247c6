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
  Chart chart{"Gain at 7 m/s that equalises loops", "period / ms", "gain", false, {}, false};
  const auto add = [&](const std::string& name, auto value) {
    ChartSeries series{name, {}, {}};
    for (std::size_t l = 0; l < kLoopLengths.size(); ++l) {
      series.x.push_back(1e3 * kLoopLengths[l] / kLoopSpeeds[LoopTable::usual_speed()]);
      series.y.push_back(value(l));
    }
    chart.series.push_back(series);
  };
  const auto of = [&](std::size_t skin, double LoopStrength::*strength) {
    return [&table, skin, strength](std::size_t l) {
      return kLongestGain * relative_gains(table.skins[skin], strength)[l];
    };
  };
  const std::size_t middle = table.skins.size() / 2;
  add("along the loop, waves of 7 m/s", of(middle, &LoopStrength::along));
  add("5 m/s", of(middle - 3, &LoopStrength::along));
  add("10 m/s", of(middle + 3, &LoopStrength::along));
  add("whole loop, 7 m/s", of(middle, &LoopStrength::intensity));
  add("exponent 1/2", [](std::size_t l) {
    return kLongestGain * std::sqrt(kLoopLengths[l] / kLoopLengths.back());
  });
  return chart;
}

Chart speed_chart(const LoopTable& table) {
  Chart chart{"Strength along a loop",
              "speed of the focal point / (m/s)",
              "equivalent displacement at 250 Hz / µm rms",
              false,
              {},
              false};
  for (std::size_t l = 0; l < kLoopLengths.size(); l += 2) {
    ChartSeries series{fmt::format("{:.0f} mm", 1e3 * kLoopLengths[l]),
                       {kLoopSpeeds.begin(), kLoopSpeeds.end()},
                       {}};
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
  LoopTable out;
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

std::vector<double> relative_gains(const SkinLoops& loops, double LoopStrength::*strength) {
  const std::size_t usual = LoopTable::usual_speed();
  std::vector<double> out;
  for (const auto& of_length : loops) {
    out.push_back(loops.back()[usual].*strength / (of_length[usual].*strength));
  }
  return out;
}

double strongest_speed(const std::vector<LoopStrength>& by_speed, double LoopStrength::*strength) {
  const auto weaker = [&](const LoopStrength& a, const LoopStrength& b) {
    return a.*strength < b.*strength;
  };
  return kLoopSpeeds[static_cast<std::size_t>(
      std::max_element(by_speed.begin(), by_speed.end(), weaker) - by_speed.begin())];
}

void draw_loops(const LoopTable& table, const std::string& path) {
  draw_charts({gain_chart(table), speed_chart(table)}, path);
}

}  // namespace prostm::experiments
