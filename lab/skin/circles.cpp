/// Tables of the perceived intensity of circles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/experiments/experiments.hpp"
#include "skin/tables.hpp"

namespace prostm::bench {

using namespace experiments;

namespace {

/// Returns the speed at a quantity's peak as "6.2 (4.9 – 8.8)": nominal, and range of nine skins.
std::string peaks(const CircleCurves& curves, std::vector<double> Curve::*quantity) {
  double low = HUGE_VAL, high = 0.0;
  for (const Curve& curve : curves.skins) {
    const double at = peak_place(curves.speeds, curve.*quantity);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return fmt::format("{:.1f} ({:.1f} – {:.1f})",
                     peak_place(curves.speeds, curves.nominal().*quantity), low, high);
}

void print_peaks_of_skins(const std::vector<CircleCurves>& all) {
  const auto skins = skin_settings_interval();
  fmt::print("\nspeed at which the intensity of each circle has its peak, on each skin [m/s]\n");
  for (std::size_t s = 0; s < skins.size(); ++s) {
    fmt::print("  plateau {:>4.0f} m/s, loss {:.2f}:", skins[s].fast_speed, skins[s].loss);
    for (const CircleCurves& curves : all) {
      fmt::print(" {:>6.1f}", peak_place(curves.speeds, curves.skins[s].intensity));
    }
    fmt::print("\n");
  }
}

void print_curves(const CircleCurves& curves) {
  fmt::print("\ncircle of {:.0f} mm: rms displacement at 250 Hz that is felt alike [µm]\n",
             1e3 * curves.circumference);
  fmt::print("{:>8} {:>8} {:>9} {:>17} {:>12} {:>20} {:>18}\n", "m/s", "Hz", "nominal",
             "low – high", "memoryless", "displacement [µm]", "velocity [mm/s]");
  for (std::size_t i = 0; i < curves.speeds.size(); ++i) {
    double low = HUGE_VAL, high = 0.0;
    for (const Curve& curve : curves.skins) {
      low = std::min(low, curve.intensity[i]);
      high = std::max(high, curve.intensity[i]);
    }
    const Curve& nominal = curves.nominal();
    fmt::print("{:>8.0f} {:>8.1f} {:>9.3f} {:>8.3f} – {:>6.3f} {:>12.3f} {:>20.3f} {:>18.3f}\n",
               curves.speeds[i], curves.speeds[i] / curves.circumference,
               1e6 * nominal.intensity[i], 1e6 * low, 1e6 * high,
               1e6 * curves.memoryless.intensity[i], 1e6 * nominal.displacement[i],
               1e3 * nominal.velocity[i]);
  }
}

}  // namespace

void compute_circles(const std::string& figure, std::vector<Row>& rows) {
  const auto skins = skin_settings_interval();
  const std::vector<CircleCurves> all = circle_curves(kCircumferences, skins, [] {});
  for (const CircleCurves& curves : all) print_curves(curves);
  fmt::print(
      "\nspeed of the peak [m/s], nominal (lowest – highest of nine skins); published: 5 to 8\n");
  fmt::print("{:>8} {:>22} {:>12} {:>24} {:>24}\n", "mm", "intensity", "memoryless", "displacement",
             "velocity");
  for (const CircleCurves& of : all) {
    fmt::print("{:>8.0f} {:>22} {:>12.1f} {:>24} {:>24}\n", 1e3 * of.circumference,
               peaks(of, &Curve::intensity), peak_place(of.speeds, of.memoryless.intensity),
               peaks(of, &Curve::displacement), peaks(of, &Curve::velocity));
    rows.push_back(value_row(fmt::format("circle {:.0f} mm, peak", 1e3 * of.circumference), "m/s",
                             peak_place(of.speeds, of.nominal().intensity)));
  }
  print_peaks_of_skins(all);
  if (!figure.empty()) draw_circles(all, figure);
}

}  // namespace prostm::bench
