/// Tables of the skin's velocity under squares.
#include <fmt/format.h>

#include "prostm/experiments/experiments.hpp"
#include "skin/tables.hpp"

namespace prostm::bench {

using namespace experiments;

namespace {

constexpr int kFastest = 12;  // [m/s]

/// Returns the speeds from 1 to 12 m/s at which `holds` is true: "8, 9".
template <class Holds>
std::string speeds_where(const std::vector<Look>& looks, Holds holds) {
  std::string text;
  for (std::size_t i = 0; i < looks.size(); ++i) {
    if (holds(looks[i])) text += fmt::format("{}{}", text.empty() ? "" : ", ", i + 1);
  }
  return text.empty() ? "none" : text;
}

void print_looks(double side, const std::vector<Look>& rms, const std::vector<Look>& largest) {
  fmt::print("\nsquare of {:.0f} cm, velocity of the nominal skin, rms over a lap and largest\n",
             100.0 * side);
  fmt::print("{:>6} {:>8} {:>10} {:>15} {:>15} {:>8} {:>16} | {:>15} {:>15} {:>8}\n", "m/s", "Hz",
             "rms [mm/s]", "middle/outline", "inside/largest", "peak in", "half area [mm]",
             "middle/outline", "inside/largest", "peak in");
  for (std::size_t i = 0; i < rms.size(); ++i) {
    const double speed = static_cast<double>(i + 1);
    const Look &r = rms[i], &l = largest[i];
    fmt::print(
        "{:>6.0f} {:>8.1f} {:>10.3f} {:>15.2f} {:>15.2f} {:>8} {:>16.1f} | {:>15.2f} {:>15.2f} "
        "{:>8}\n",
        speed, speed / (4.0 * side), 1e3 * r.outline, r.middle, r.inside,
        r.peak_inside ? "yes" : "no", 1e3 * r.half_width, l.middle, l.inside,
        l.peak_inside ? "yes" : "no");
  }
}

/// Prints one size on the nine skins.
void print_square(double side, std::vector<Row>& rows) {
  fmt::print(
      "\nsquare of {:.0f} cm: speeds [m/s] at which a peak lies in the inner half, rms and largest "
      "velocity\n",
      100.0 * side);
  std::vector<double> speeds;
  for (int speed = 1; speed <= kFastest; ++speed) speeds.push_back(speed);
  const auto skins = skin_settings_interval();
  const std::vector<SquareLooks> looks = square_looks(side, speeds, skins, [] {});
  const auto inside = [](const Look& look) { return look.peak_inside; };
  for (std::size_t s = 0; s < skins.size(); ++s) {
    fmt::print("  plateau {:>4.0f} m/s, loss {:.2f}: {:<30} {}\n", skins[s].fast_speed,
               skins[s].loss, speeds_where(looks[s].rms, inside),
               speeds_where(looks[s].largest, inside));
  }
  const SquareLooks& nominal = looks[looks.size() / 2];
  print_looks(side, nominal.rms, nominal.largest);
  rows.push_back(
      value_row(fmt::format("square {:.0f} cm, 8 m/s, middle over outline", 100.0 * side), "1",
                nominal.rms[7].middle));
}

}  // namespace

void compute_squares(const std::string& figure, std::vector<Row>& rows) {
  for (const double side : kSquareSides) print_square(side, rows);
  if (!figure.empty()) draw_squares(figure);
}

}  // namespace prostm::bench
