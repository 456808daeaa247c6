#pragma once
/// Psychometric functions: the share of right answers as a function of the stimulus level.

#include <cstdint>
#include <optional>
#include <span>

#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// ψ(x) = γ + (1 − γ − λ) / (1 + e^{−s (x − t)}): a logistic function with a guess rate γ and a
/// lapse rate λ.
struct Psychometric {
  double threshold = 0.0;  ///< t, level half-way between the asymptotes γ and 1 − λ
  double slope = 1.0;      ///< s > 0, per unit of the level
  double guess = 0.5;      ///< γ, 0 for yes/no, 1/2 for two intervals
  double lapse = 0.0;      ///< λ, share of wrong answers at arbitrarily high levels

  /// Returns the share of right answers at a level.
  double at(double level) const;
};

/// Right answers at one level.
struct LevelScore {
  double level = 0.0;
  Proportion correct;
};

/// Fixed parameters, and the confidence level of intervals.
struct PsychometricSettings {
  double guess = 0.5;                  ///< γ
  std::optional<double> lapse = 0.02;  ///< λ; nothing: fitted between 0 and kMostLapse
  double level = 0.95;                 ///< confidence level of intervals, 0..1
  std::uint64_t seed = 1;              ///< of the bootstrap samples of Misfit
};
inline constexpr double kMostLapse = 0.2;

/// Goodness of fit: the deviance, twice the log-likelihood ratio of the observed shares to the fit,
/// and its p value, the share of fits to answers drawn from the function with a deviance at least
/// as large (parametric bootstrap, Wichmann and Hill 2001; sequential, Besag and Clifford,
/// Biometrika 78, 301 (1991)).
struct Misfit {
  double deviance = 0.0;
  int df = 0;  ///< levels minus parameters
  double p = 1.0;
};

struct PsychometricFit {
  Psychometric function;
  /// by profile likelihood; an end that the answers do not bound is infinite; nothing if both are
  std::optional<Interval> threshold;
  std::optional<Interval> slope;  ///< nothing if an end is unbounded
  double log_likelihood = 0.0;    ///< without the constant binomial coefficients
  std::optional<Misfit> misfit;   ///< nothing unless there are more levels than parameters
};

/// The reason why no threshold and slope can be fitted.
enum class NoFit : std::uint8_t {
  TooFewLevels,  ///< fewer than two
  NotGrowing,    ///< the share of right answers hardly grows with the level, or not at all
  Falling,       ///< it falls (Cochran and Armitage's trend, two-sided p < 0.05)
  Step,          ///< it jumps from one level to the next: any steep slope fits
  BelowLevels,   ///< the share is high at all levels: the threshold lies below them
  AboveLevels    ///< the share is low at all levels: the threshold lies above them
};

/// Bounds of the threshold if no function maximises the likelihood: a censored result. An end that
/// the answers do not bound is infinite.
struct ThresholdBounds {
  Interval best;      ///< maximum-likelihood thresholds: between two levels, or beyond all
  Interval interval;  ///< by profile likelihood over all slopes, including steps
};

struct PsychometricResult {
  std::optional<PsychometricFit> fit;
  NoFit no_fit = NoFit::TooFewLevels;     ///< where there is no fit
  std::optional<ThresholdBounds> bounds;  ///< where there is no fit, but bounds
};

/// Finds the maximum-likelihood threshold and slope, or bounds of the threshold.
/// @pre trials > 0 at each level, guess + lapse < 1, guess + kMostLapse < 1 if lapse is fitted.
PsychometricResult fit_psychometric(std::span<const LevelScore> scores,
                                    const PsychometricSettings& settings);

}  // namespace prostm
