/// A focal point on a straight line: the reach of its waves ahead and behind.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/figure/figures.hpp"
#include "skin/experiments.hpp"
#include "skin/stimuli.hpp"
#include "skin/wake.hpp"

namespace prostm::bench {
namespace {

constexpr int kFastest = 12;  // [m/s]
constexpr double kShown[] = {2, 4, 6, 7, 8, 10};
const SkinPatch kPatch{101, 151, 2e-3};
constexpr int kFocusRow = 50, kFocusCol = 110;
constexpr double kUsxLevel = 1125.0;  // highest level measured in a focus [Pa rms]

/// Returns the pressure of the array's focus at 200 mm in the moving patch, as if it were at rest.
/// The loss by the transducers' lag, (A9), is included in the loops of the other experiments.
std::vector<double> focus() {
  constexpr int kCells = 41;  // the focus and its first side lobes
  const Palm palm{SkinPatch{kCells, kCells, kPatch.cell}};
  const std::vector<double> square = foci_pressure(usx_array(), palm, {Vec2::Zero()});
  std::vector<double> pressure(static_cast<std::size_t>(kPatch.rows * kPatch.cols), 0.0);
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      const int row = kFocusRow + j - kCells / 2, col = kFocusCol + i - kCells / 2;
      pressure[static_cast<std::size_t>(row * kPatch.cols + col)] =
          square[static_cast<std::size_t>(j * kCells + i)];
    }
  }
  return pressure;
}

/// Evaluates the patch from `first_col` on. The patch reaches 80 mm ahead of the focus and 220 mm
/// behind it.
Reach reach_of(const std::vector<double>& velocity, int first_col = 0) {
  double energy[2] = {0.0, 0.0}, moment[2] = {0.0, 0.0};
  for (int j = 0; j < kPatch.rows; ++j) {
    for (int i = first_col; i < kPatch.cols; ++i) {
      const double v = velocity[static_cast<std::size_t>(j * kPatch.cols + i)];
      const double x = kPatch.cell * (i - kFocusCol);
      const int side = x < 0.0 ? 1 : 0;
      energy[side] += v * v;
      moment[side] += v * v * x * x;
    }
  }
  return {std::sqrt(moment[0] / energy[0]), std::sqrt(moment[1] / energy[1])};
}

std::vector<SpeedReach> reaches_of(const std::vector<double>& pressure,
                                   std::span<const double> speeds, Skins skins, const Step& step) {
  const int even_col = 2 * kFocusCol - kPatch.cols + 1;
  std::vector<SpeedReach> out;
  for (const double speed : speeds) {
    SpeedReach& at = out.emplace_back();
    at.speed = speed;
    for (std::size_t s = 0; s < skins.size(); ++s) {
      const auto velocity = wake_velocity(SkinModel(skins[s]), kPatch, pressure, speed);
      const Reach reach = reach_of(velocity);
      at.ratios.push_back(reach.behind / reach.ahead);
      if (s != skins.size() / 2) continue;
      at.nominal = reach;
      at.even = reach_of(velocity, even_col);
    }
    step();
  }
  return out;
}

void print_reaches(const std::vector<double>& pressure, std::vector<Row>& rows) {
  fmt::print("\nfocal point on a straight line: rms distance of the skin's moving energy [mm]\n");
  fmt::print("{:>6} {:>8} {:>8} {:>8} {:>8}   {}\n", "m/s", "ahead", "behind", "ratio", "80 mm",
             "ratio on the nine skins; 80 mm: the ratio within as much behind as ahead");
  std::vector<double> speeds;
  for (int speed = 1; speed <= kFastest; ++speed) speeds.push_back(speed);
  const auto skins = skin_settings_interval();
  for (const SpeedReach& at : reaches_of(pressure, speeds, skins, [] {})) {
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

std::vector<SpeedReach> line_reaches(std::span<const double> speeds, Skins skins,
                                     const Step& step) {
  return reaches_of(focus(), speeds, skins, step);
}

void compute_regimes(const std::string& figure, std::vector<Row>& rows) {
  print_reaches(focus(), rows);
  print_level(rows);
  if (!figure.empty()) draw_lines(figure);
}

void draw_lines(const std::string& path) {
  const std::vector<double> pressure = focus();
  MapFigure picture{"Skin velocity (magnitude) under a focal point that moves to the right",
                    "of the largest",
                    3,
                    {}};
  for (const double speed : kShown) {
    FieldMap map{fmt::format("{:.0f} m/s", speed),
                 "",
                 kPatch.rows,
                 kPatch.cols,
                 kPatch.cell,
                 wake_velocity(SkinModel(SkinSettings()), kPatch, pressure, speed)};
    const Reach reach = reach_of(map.values);
    for (double& v : map.values) v = std::abs(v);
    map.note =
        fmt::format("{:.0f} mm ahead, {:.0f} mm behind", 1e3 * reach.ahead, 1e3 * reach.behind);
    picture.maps.push_back(map);
  }
  draw_maps(picture, path);
}

}  // namespace prostm::bench
