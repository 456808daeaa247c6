#pragma once
/// γ, the rendered pressure of a path over its effective pressure, (P9b) of docs/design.md.

#include <algorithm>
#include <cmath>

namespace prostm {

/// γ(T) = gain · (T · draw_rate)^exponent for a path whose lap takes T. So `gain` is the γ of the
/// longest path, and of every path if the exponent is 0. T · draw_rate counts as at least 1/16 and
/// at most 16, since a much shorter loop is a point at rest.
struct GainLaw {
  double gain = 1.4;  ///< > 0
  double exponent = 0.0;
  double draw_rate = 50.0;  ///< laps per second of the longest path [Hz], > 0

  /// Returns γ(T). @param period T [s], ≥ 0 and finite.
  double of(double period) const {
    constexpr double kLeast = 1.0 / 16.0, kMost = 16.0;
    return gain * std::pow(std::clamp(period * draw_rate, kLeast, kMost), exponent);
  }
};

}  // namespace prostm
