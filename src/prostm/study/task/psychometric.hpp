#pragma once
/// How the share of right answers grows with the level of a stimulus.

#include <cstdint>
#include <optional>
#include <span>

#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// ψ(x) = γ + (1 − γ − λ) / (1 + e^{−s (x − t)}): a logistic function with guesses and lapses.
struct Psychometric {
  double threshold = 0.0;  ///< t, the level half-way between guessing and the most
  double slope = 1.0;      ///< s > 0, per unit of the level
  double guess = 0.5;      ///< γ, 0 for yes/no, 1/2 for two intervals
  double lapse = 0.0;      ///< λ, share of wrong answers however high the level

  /// Returns the share of right answers at a level.
  double at(double level) const;
};

/// Right answers at one level.
struct LevelScore {
  double level = 0.0;
  Proportion correct;
};

/// Parameters that are given, and how sure intervals are.
struct PsychometricSettings {
  double guess = 0.5;                  ///< γ
  std::optional<double> lapse = 0.02;  ///< λ; nothing: fitted, from 0 to kMostLapse
  double level = 0.95;                 ///< of intervals, 0..1
  std::uint64_t seed = 1;              ///< of the samples that a misfit is judged by
};
inline constexpr double kMostLapse = 0.2;

/// Whether answers are further from their function than answers of that function would be: the
/// deviance, twice the logarithm of the likelihood that is missing to the shares themselves, and
/// the share of fits to answers drawn from the function that have as large a one (parametric
/// bootstrap, Wichmann and Hill 2001; sequential, Besag and Clifford, Biometrika 78, 301 (1991)).
struct Misfit {
  double deviance = 0.0;
  int df = 0;  ///< levels minus parameters
  double p = 1.0;
};

struct PsychometricFit {
  Psychometric function;
  /// by the profile of the likelihood, an end that the answers leave open is infinite; nothing
  /// where both are
  std::optional<Interval> threshold;
  std::optional<Interval> slope;  ///< nothing where an end is open
  double log_likelihood = 0.0;    ///< without the binomial coefficients, which do not matter
  std::optional<Misfit> misfit;   ///< nothing with no more levels than parameters
};

/// Why answers have no threshold and slope.
enum class NoFit : std::uint8_t {
  TooFewLevels,  ///< fewer than two
  NotGrowing,    ///< the share of right answers does not grow over the levels, or hardly
  Falling,       ///< it falls (Cochran and Armitage's trend, two-sided p < 0.05)
  Step,          ///< it jumps from one level to the next: any steep slope fits
  BelowLevels,   ///< it is high at all levels
  AboveLevels    ///< it is low at all levels
};

/// Where the threshold lies if no function has the largest likelihood: a censored result. An end
/// that the answers leave open is infinite.
struct ThresholdBounds {
  Interval best;      ///< thresholds of the largest likelihood: between two levels, or beyond all
  Interval interval;  ///< by the profile of the likelihood over all slopes, steps included
};

struct PsychometricResult {
  std::optional<PsychometricFit> fit;
  NoFit no_fit = NoFit::TooFewLevels;     ///< where there is no fit
  std::optional<ThresholdBounds> bounds;  ///< where there is no fit, but bounds
};

/// Finds the threshold and slope of the largest likelihood, or the bounds of the threshold.
/// @pre trials > 0 at each level, guess + lapse < 1, guess + kMostLapse < 1 if lapse is fitted.
PsychometricResult fit_psychometric(std::span<const LevelScore> scores,
                                    const PsychometricSettings& settings);

}  // namespace prostm
