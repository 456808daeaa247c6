#pragma once
/// How the share of right answers grows with the level of a stimulus.

#include <cstdint>
#include <optional>
#include <span>

#include "prostm/study/statistics.hpp"

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

struct PsychometricFit {
  Psychometric function;
  /// by the profile of the likelihood; nothing where the answers leave an end open
  std::optional<Interval> threshold, slope;
  double log_likelihood = 0.0;  ///< without the binomial coefficients, which do not matter
};

/// Why answers bound no threshold and slope.
enum class NoFit : std::uint8_t {
  TooFewLevels,  ///< fewer than two
  NotGrowing,    ///< the share of right answers does not grow over the levels, or hardly
  Step           ///< from one level to the next: any steep slope fits
};

/// Returns the threshold and slope of the largest likelihood, guess and lapse given. Nothing where
/// the answers do not bound them. @param level of the intervals, 0..1. @param why set where there
/// is no fit. @pre trials > 0 at each level, guess + lapse < 1.
std::optional<PsychometricFit> fit_psychometric(std::span<const LevelScore> scores, double guess,
                                                double lapse, double level = 0.95,
                                                NoFit* why = nullptr);

}  // namespace prostm
