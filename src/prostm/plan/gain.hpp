#pragma once
/// γ, the rendered pressure of a path over its effective pressure, (P9b) and (P9c) of
/// docs/design/planner.md.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace prostm {

/// γ relative to a loop of 20 ms, for loops of 5, 7.5, … 20 ms drawn at 7 m/s. With these values
/// the percept along the loop is equally strong for all of them, by the nominal skin of
/// docs/design/skin.md. The lab computes the table; a test verifies it.
inline constexpr std::array<double, 7> kSkinGains = {0.713, 0.744, 0.825, 0.869, 0.930, 0.975, 1.0};
/// Interpolates kSkinGains linearly at a period ≥ 0 [s]; periods outside its range are clamped.
inline double skin_gain(double period) {
  constexpr double kFirst = 5e-3, kStep = 2.5e-3;
  const double place =
      std::clamp((period - kFirst) / kStep, 0.0, static_cast<double>(kSkinGains.size() - 1));
  const std::size_t below = std::min(static_cast<std::size_t>(place), kSkinGains.size() - 2);
  const double share = place - static_cast<double>(below);
  return (1.0 - share) * kSkinGains[below] + share * kSkinGains[below + 1];
}

/// γ(T) = gain · (T · draw_rate)^exponent for a path whose lap takes T. So `gain` is the γ of the
/// longest path, and of every path if the exponent is 0. T · draw_rate is clamped to [1/16, 16],
/// since a much shorter loop is a point at rest. With `from_skin`, γ(T) is proportional to
/// skin_gain(T) instead, (P9c); `gain` is still the γ of the longest path.
struct GainLaw {
  double gain = 1.4;  ///< > 0
  double exponent = 0.0;
  double draw_rate = 50.0;  ///< laps per second of the longest path [Hz], > 0
  bool from_skin = false;   ///< whether skin_gain() replaces the exponent

  /// Returns γ(T). @param period T [s], ≥ 0 and finite.
  double of(double period) const {
    if (from_skin) return gain * skin_gain(period) / skin_gain(1.0 / draw_rate);
    constexpr double kLeast = 1.0 / 16.0, kMost = 16.0;
    return gain * std::pow(std::clamp(period * draw_rate, kLeast, kMost), exponent);
  }
};

}  // namespace prostm
