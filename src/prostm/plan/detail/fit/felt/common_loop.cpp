#include "prostm/plan/detail/fit/felt/common_loop.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr int kSteps = 20;           // periods tried are multiples of longest / kSteps …
constexpr int kLeastSteps = 10;      // … with at least this factor
constexpr int kMostLaps = 8;         // maximum laps of a path in a loop
constexpr double kRounding = 1e-9;   // share of a lap that is ignored
constexpr double kHysteresis = 1.1;  // factor of gain that justifies a new loop

/// Σ (speed over own speed)² in a loop; 0 if it is too short for a path.
double squared_speeds(std::span<const double> own, const CommonLoop& loop) {
  double sum = 0.0;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (loop.laps[k] == 0) return 0.0;
    const double share = loop.laps[k] * own[k] / loop.period;
    sum += share * share;
  }
  return sum;
}

}  // namespace

CommonLoop loop_of(std::span<const double> own, double period) {
  CommonLoop loop{period, {}, 0.0};
  for (std::size_t k = 0; k < own.size(); ++k) {
    loop.laps[k] = static_cast<int>(std::min(period / own[k] + kRounding, double{kMostLaps}));
    loop.pace += loop.laps[k] * own[k] / (period * static_cast<double>(own.size()));
  }
  return loop;
}

CommonLoop choose_loop(std::span<const double> own, double longest, double before) {
  CommonLoop best = loop_of(own, longest);
  double most = squared_speeds(own, best);
  for (int steps = kSteps - 1; steps >= kLeastSteps; --steps) {
    const CommonLoop loop = loop_of(own, longest * steps / kSteps);
    const double value = squared_speeds(own, loop);
    if (value <= most * (1.0 + kRounding)) continue;
    best = loop;
    most = value;
  }
  if (before <= 0.0) return best;
  const CommonLoop kept = loop_of(own, before);
  return kHysteresis * squared_speeds(own, kept) >= most ? kept : best;
}

}  // namespace prostm::planning
