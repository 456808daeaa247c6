#pragma once
/// γ, the rendered pressure of a path over its effective pressure, (P9b) and (P9c) of
/// docs/design/planner.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace prostm {

/// γ over that of a loop of 20 ms, for loops of 5, 7.5, … 20 ms that a focal point at 7 m/s draws:
/// what makes them felt alike along the loop by the nominal skin of docs/design/skin.md. The
/// lab computes it, and a test does so anew.
inline constexpr std::array<double, 7> kSkinGains = {0.713, 0.744, 0.825, 0.869, 0.930, 0.975, 1.0};
/// Returns kSkinGains at a period ≥ 0 [s], linear in between; beyond its ends, that of the end.
inline double skin_gain(double period) {
  constexpr double kFirst = 5e-3, kStep = 2.5e-3;
  const double place =
      std::clamp((period - kFirst) / kStep, 0.0, static_cast<double>(kSkinGains.size() - 1));
  const std::size_t below = std::min(static_cast<std::size_t>(place), kSkinGains.size() - 2);
  const double share = place - static_cast<double>(below);
  return (1.0 - share) * kSkinGains[below] + share * kSkinGains[below + 1];
}

/// γ(T) = gain · (T · draw_rate)^exponent for a path whose lap takes T. So `gain` is the γ of the
/// longest path, and of every path if the exponent is 0. T · draw_rate counts as at least 1/16 and
/// at most 16, since a much shorter loop is a point at rest. With `from_skin` γ(T) goes with
/// skin_gain(T) instead, (P9c), and `gain` still is that of the longest path.
struct GainLaw {
  double gain = 1.4;  ///< > 0
  double exponent = 0.0;
  double draw_rate = 50.0;  ///< laps per second of the longest path [Hz], > 0
  bool from_skin = false;   ///< then the exponent is not used

  /// Returns γ(T). @param period T [s], ≥ 0 and finite.
  double of(double period) const {
    if (from_skin) return gain * skin_gain(period) / skin_gain(1.0 / draw_rate);
    constexpr double kLeast = 1.0 / 16.0, kMost = 16.0;
    return gain * std::pow(std::clamp(period * draw_rate, kLeast, kMost), exponent);
  }
};

}  // namespace prostm
