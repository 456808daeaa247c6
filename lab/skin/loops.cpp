/// Tables of how strongly loops are felt.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/experiments/experiments.hpp"
#include "skin/tables.hpp"

namespace prostm::bench {

using namespace experiments;

namespace {

/// Formats a number and its range over the skins as "1.02 (0.94 – 1.10)", the nominal one first.
template <class Figure>
std::string over_skins(std::size_t skins, Figure figure) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (std::size_t s = 0; s < skins; ++s) {
    low = std::min(low, figure(s));
    high = std::max(high, figure(s));
  }
  return fmt::format("{:.2f} ({:.2f} – {:.2f})", figure(skins / 2), low, high);
}

void print_gains(const LoopTable& table, std::vector<Row>& rows) {
  const std::size_t middle = table.skins.size() / 2;
  fmt::print(
      "\ngain of a loop at {:.0f} m/s that is felt as the longest with {:.1f}, nominal (lowest – "
      "highest of nine skins)\n{:>8} {:>8} {:>22} {:>22} {:>12}\n",
      kUsualSpeed, kLongestGain, "mm", "ms", "along the loop", "whole loop", "exponent 1/2");
  for (std::size_t l = 0; l < table.lengths.size(); ++l) {
    const double period = table.lengths[l] / kUsualSpeed;
    const auto gain = [&](double LoopStrength::*strength) {
      return over_skins(table.skins.size(), [&](std::size_t s) {
        return kLongestGain * relative_gains(table, s, strength)[l];
      });
    };
    fmt::print("{:>8.1f} {:>8.1f} {:>22} {:>22} {:>12.2f}\n", 1e3 * table.lengths[l], 1e3 * period,
               gain(&LoopStrength::along), gain(&LoopStrength::intensity),
               kLongestGain * std::sqrt(table.lengths[l] / table.lengths.back()));
    rows.push_back(
        value_row(fmt::format("loop {:.1f} mm, gain", 1e3 * table.lengths[l]), "",
                  kLongestGain * relative_gains(table, middle, &LoopStrength::along)[l]));
  }
}

void print_strengths(const LoopTable& table, double LoopStrength::*strength, const char* name) {
  fmt::print("\n{} on the nominal skin [µm], and the speed that is felt strongest\n{:>8}", name,
             "mm");
  for (const double speed : table.speeds) fmt::print(" {:>6.0f}", speed);
  fmt::print(" m/s {:>6} (all nine skins)\n", "best");
  for (std::size_t l = 0; l < table.lengths.size(); ++l) {
    fmt::print("{:>8.1f}", 1e3 * table.lengths[l]);
    for (const LoopStrength& here : table.nominal()[l])
      fmt::print(" {:>6.3f}", 1e6 * here.*strength);
    fmt::print(" {:>10.0f}", strongest_speed(table, table.skins.size() / 2, l, strength));
    for (std::size_t s = 0; s < table.skins.size(); ++s)
      fmt::print(" {:>2.0f}", strongest_speed(table, s, l, strength));
    fmt::print("\n");
  }
}

}  // namespace

void compute_loops(const std::string& figure, std::vector<Row>& rows) {
  const LoopTable table = loop_table(kLoopLengths, kLoopSpeeds, skin_settings_interval(), [] {});
  print_gains(table, rows);
  print_strengths(table, &LoopStrength::along, "strength along the loop, mean √e,");
  print_strengths(table, &LoopStrength::intensity, "strength of the whole loop, √E,");
  if (!figure.empty()) draw_loops(table, figure);
}

}  // namespace prostm::bench
