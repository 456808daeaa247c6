#pragma once
/// Sizes of differences between two methods over participants, with intervals; equivalence tests,
/// Bayes factors, and corrections for several comparisons. Equations: docs/design/study.md (Y7) to
/// (Y10).

#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "prostm/study/task/statistics.hpp"

namespace prostm {

/// An estimate with its confidence interval.
struct Estimate {
  double value = 0.0;
  Interval interval;
};

/// Values of two methods, one for each participant. Differences are b minus a.
struct TwoSamples {
  std::span<const double> a, b;
  Groups groups = Groups::Between;  ///< Within: a and b are pairs

  /// Whether there are two values of each method, and differences vary by more than rounding.
  bool varies() const;
};

/// The difference of means, with the interval of Welch's or the paired t test. Nothing unless the
/// samples vary. @param level of confidence, 0..1. @pre pairs have the same size.
std::optional<Estimate> mean_difference(const TwoSamples& of, double level = 0.95);

/// Cohen's d, or d_z of pairs, with an interval from the noncentral t distribution (Y7). It is
/// exact for normal values; between participants also with equal variances. Nothing unless the
/// samples vary.
std::optional<Estimate> standardised_difference(const TwoSamples& of, double level = 0.95);

/// Two one-sided t tests (TOST) of a difference of means within ±bound (Y8).
struct Equivalence {
  double bound = 0.0;      ///< in the unit of the values
  double p_above_low = 1;  ///< one-sided, against differences of at most −bound
  double p_below_high = 1;
  double p() const { return p_above_low > p_below_high ? p_above_low : p_below_high; }
  Interval interval;  ///< of the difference, at level 1 − 2 alpha: inside the bounds if p < alpha
};
/// Welch's or the paired t test (Schuirmann, J. Pharmacokinet. Biopharm. 15, 657 (1987)). Nothing
/// unless the samples vary. @pre bound > 0, 0 < alpha < 0.5.
std::optional<Equivalence> equivalence(const TwoSamples& of, double bound, double alpha = 0.05);

/// Scale of the Cauchy prior of effect sizes, the default of R's BayesFactor.
inline constexpr double kPriorScale = 0.5 * std::numbers::sqrt2;
/// Returns the Bayes factor of a t value for a difference over none, with a Cauchy prior of the
/// effect size (JZS: Rouder et al., Psychon. Bull. Rev. 16, 225 (2009)) (Y9).
/// The largest double if it is beyond that. @param n pairs, or n m / (n + m) for two groups. @param
/// df degrees of freedom. @pre n, df, scale > 0; t is finite.
double jzs_bayes_factor(double t, double n, double df, double scale = kPriorScale);
/// The same of two samples, by the paired t test or that of two groups with equal variances.
/// Nothing unless the samples vary.
std::optional<double> bayes_factor(const TwoSamples& of, double scale = kPriorScale);

/// Returns p values corrected for their number by Holm's method (Scand. J. Stat. 6, 65 (1979)), in
/// the order given.
std::vector<double> holm(std::span<const double> p);

}  // namespace prostm
