#include "prostm/plan/detail/fit/felt/common_loop.hpp"

#include <algorithm>
#include <cmath>

namespace prostm::planning {
namespace {

constexpr int kSteps = 20;           // a loop is a multiple of the longest over this …
constexpr int kLeastSteps = 10;      // … and at least so many of them
constexpr int kMostLaps = 8;         // of a path in a loop
constexpr double kRounding = 1e-9;   // share of a lap that does not count
constexpr double kHysteresis = 1.1;  // gain for which the last plan's loop is given up

/// Σ (speed over own speed)² in a loop; 0 if it is too short for a path.
double quickness(std::span<const double> own, const CommonLoop& loop) {
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
  double most = quickness(own, best);
  for (int steps = kSteps - 1; steps >= kLeastSteps; --steps) {
    const CommonLoop loop = loop_of(own, longest * steps / kSteps);
    const double value = quickness(own, loop);
    if (value <= most * (1.0 + kRounding)) continue;
    best = loop;
    most = value;
  }
  if (before <= 0.0) return best;
  const CommonLoop kept = loop_of(own, before);
  return kHysteresis * quickness(own, kept) >= most ? kept : best;
}

}  // namespace prostm::planning
