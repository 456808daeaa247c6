/// Tables of the gap from which two foci are felt as two.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/experiments/experiments.hpp"
#include "skin/tables.hpp"

namespace prostm::bench {

using namespace experiments;

namespace {

std::string gap_text(double gap) {
  return gap > 0.0 ? fmt::format("{:.1f}", 1e3 * gap) : "over 60";
}

}  // namespace

void compute_gap(const std::string& figure, std::vector<Row>& rows) {
  const auto skins = skin_settings_interval();
  const GapCurves curves = gap_curves(skins, [] {});
  const std::vector<double>&gaps = curves.gaps, &acoustic = curves.acoustic;
  const std::vector<std::vector<double>>& felt = curves.felt;
  fmt::print("\ntwo foci at {:.0f} Hz: middle over the higher peak\n", kGapRate);
  fmt::print("{:>8} {:>20} {:>16} {:>16}\n", "gap [mm]", "radiation pressure", "felt, nominal",
             "low – high");
  for (std::size_t i = 0; i < gaps.size(); i += 2) {
    double low = HUGE_VAL, high = 0.0;
    for (const auto& dips : felt) {
      low = std::min(low, dips[i]);
      high = std::max(high, dips[i]);
    }
    fmt::print("{:>8.1f} {:>20.2f} {:>16.2f} {:>8.2f} – {:.2f}\n", 1e3 * gaps[i], acoustic[i],
               felt[4][i], low, high);
  }
  fmt::print(
      "\ngap [mm] from which there are two places, a dip of 1 % and of 20 %; published: merged "
      "acoustically below 15 to 18, "
      "felt as one below 15, as two by half at 32.3, by 84 % at 45\n");
  const auto line = [&](const std::string& name, const std::vector<double>& dips) {
    fmt::print("{:<36} {:>10} {:>10}\n", name, gap_text(gap_where(gaps, dips, 0.99)),
               gap_text(gap_where(gaps, dips, kNoticed)));
  };
  line("radiation pressure", acoustic);
  for (std::size_t s = 0; s < skins.size(); ++s) {
    line(fmt::format("felt, plateau {:.0f} m/s, loss {:.2f}", skins[s].fast_speed, skins[s].loss),
         felt[s]);
  }
  rows.push_back(value_row("gap of two foci, radiation pressure", "mm",
                           1e3 * gap_where(gaps, acoustic, kNoticed)));
  rows.push_back(
      value_row("gap of two foci, felt", "mm", 1e3 * gap_where(gaps, felt[4], kNoticed)));
  if (!figure.empty()) draw_gap(curves, figure);
}

}  // namespace prostm::bench
