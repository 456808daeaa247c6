/// Tables of a focal point on a straight line.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/experiments/experiments.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "skin/tables.hpp"

namespace prostm::bench {

using namespace experiments;

namespace {

constexpr int kFastest = 12;          // [m/s]
constexpr double kUsxLevel = 1125.0;  // highest level measured in a focus [Pa rms]

void print_reaches(std::vector<Row>& rows) {
  fmt::print("\nfocal point on a straight line: rms distance of the skin's moving energy [mm]\n");
  fmt::print("{:>6} {:>8} {:>8} {:>8} {:>8}   {}\n", "m/s", "ahead", "behind", "ratio", "80 mm",
             "ratio on the nine skins; 80 mm: the ratio within as much behind as ahead");
  std::vector<double> speeds;
  for (int speed = 1; speed <= kFastest; ++speed) speeds.push_back(speed);
  const auto skins = skin_settings_interval();
  for (const SpeedReach& at : line_reaches(speeds, skins, [] {})) {
    const double ratio = at.nominal.behind / at.nominal.ahead;
    fmt::print("{:>6} {:>8.1f} {:>8.1f} {:>8.1f} {:>8.1f}   {:.1f} – {:.1f}\n", at.speed,
               1e3 * at.nominal.ahead, 1e3 * at.nominal.behind, ratio,
               at.even.behind / at.even.ahead, *std::ranges::min_element(at.ratios),
               *std::ranges::max_element(at.ratios));
    if (std::fmod(at.speed, 4.0) != 0.0) continue;
    rows.push_back(
        value_row(fmt::format("line at {} m/s, behind over ahead", at.speed), "1", ratio));
  }
}

/// The stimulus of Reardon 2019: to and fro at 62.5 Hz, 0.3 m above, at full drive.
void print_level(std::vector<Row>& rows) {
  Palm palm;
  palm.height = 0.3;
  const double period = 1.0 / 62.5, length = 0.056;  // 7 m/s
  const TransducerArray array = usx_array();
  const std::vector<double> pressure =
      StmField(array, palm).pressure(line_lap(length), period, false);
  std::vector<double> most;  // [m/s]
  for (const SkinSettings& settings : skin_settings_interval()) {
    SkinResponse response(SkinModel(settings), palm.patch);
    response.prepare(period, StmField::kSamples, 240.0);
    response.respond({period, StmField::kSamples, pressure});
    std::vector<double> map(palm.cells());
    rms_velocity(response, map);
    most.push_back(*std::max_element(map.begin(), map.end()));
  }
  const double full = *std::max_element(pressure.begin(), pressure.end());
  const auto line = [&](const std::string& name, double scale) {
    fmt::print("  {:<44} {:>6.1f} Pa {:>8.2f} mm/s ({:.2f} – {:.2f})\n", name, full * scale,
               1e3 * scale * most[4], 1e3 * scale * *std::min_element(most.begin(), most.end()),
               1e3 * scale * *std::max_element(most.begin(), most.end()));
  };
  fmt::print(
      "\nto and fro over {:.0f} mm at 62.5 Hz, 0.3 m above: radiation pressure of the focus, and "
      "largest "
      "rms velocity of the skin, 62.5 to 240 Hz, on the nominal skin (the nine); published: about "
      "0.1 mm/s\n",
      1e3 * length);
  for (const double amplitude : {array.amplitude_low, array.amplitude, array.amplitude_high}) {
    const double share = amplitude / array.amplitude;
    line(fmt::format("transducers of {:.1f} Pa·m", amplitude), share * share);
  }
  line("the 155 dB measured in a focus", radiation_pressure(kUsxLevel, Medium()) / full);
  rows.push_back(value_row("velocity at the focus", "mm/s", 1e3 * most[4]));
}

}  // namespace

void compute_regimes(const std::string& figure, std::vector<Row>& rows) {
  print_reaches(rows);
  print_level(rows);
  if (!figure.empty()) draw_lines(figure);
}

}  // namespace prostm::bench
