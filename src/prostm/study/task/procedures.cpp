#include "prostm/study/task/procedures.hpp"

#include <algorithm>

namespace prostm {
namespace {

constexpr double kSlope = 20.0;   // of the Bayesian staircase, times the range
constexpr double kSpread = 0.25;  // of its prior, as a share of the range
constexpr double kLapses = 0.02;
constexpr double kAway = 0.25;   // first level to the middle, over the range
constexpr double kCoarse = 4.0;  // fine steps per coarse step

double width_of(const LevelRange& range) {
  return range.high - range.low;
}

}  // namespace

Procedure staircase_of(const LevelSettings& level, double guess) {
  const LevelRange range = level.range();
  if (level.procedure == Staircase::UpDown) {
    return WeightedUpDown({.start = level.to_scale(level.start),
                           .step = level.step_on_scale(),
                           .target = level.share,
                           .coarse = level.coarse,
                           .reversals = level.reversals,
                           .range = range});
  }
  const double slope = level.slope > 0.0 ? level.slope : kSlope / width_of(range);
  return BayesianStaircase({.shape = {.slope = slope, .guess = guess, .lapse = kLapses},
                            .expected = level.to_scale(level.start),
                            .spread = kSpread * width_of(range),
                            .trials = level.trials,
                            .range = range});
}

Procedure adjustments_of(const LevelSettings& level, int repeats, std::uint64_t seed) {
  const LevelRange range = level.range();
  const double step = level.step_on_scale();
  return Adjustment({.coarse = std::min(kCoarse * step, width_of(range)),
                     .fine = step,
                     .repeats = repeats,
                     .away = kAway * width_of(range),
                     .seed = seed,
                     .range = range});
}

}  // namespace prostm
