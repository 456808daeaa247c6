#pragma once
/// Statistics of right and wrong answers. All tests are two-sided. Distributions are Boost.Math's.

#include <cstdint>
#include <optional>
#include <span>

namespace prostm {

/// Right answers out of all.
struct Proportion {
  int successes = 0, trials = 0;
  double value() const { return static_cast<double>(successes) / trials; }
};

struct Interval {
  double low = 0.0, high = 0.0;
};
/// Returns Wilson's interval of a proportion (J. Am. Stat. Assoc. 22, 209 (1927)), which holds for
/// few trials and near 0 and 1 too. @param level 0..1, e.g. 0.95. @pre trials > 0.
Interval wilson_interval(const Proportion& x, double level = 0.95);

struct TestResult {
  double statistic = 0.0;
  double df = 0.0;  ///< degrees of freedom; 0 where the test has none
  double p = 1.0;
};
/// z of two proportions with a pooled variance, b minus a. It takes every answer as independent. 0
/// with p = 1 where all answers are right, or none. @pre trials > 0.
TestResult two_proportions_z(const Proportion& a, const Proportion& b);
/// p of Fisher's exact test on the 2 × 2 table of right and wrong: tables as unlikely as this one,
/// or more. @pre trials > 0.
double fisher_exact_p(const Proportion& a, const Proportion& b);
/// p of the exact binomial test against a share of right answers that guessing makes: counts as
/// unlikely as this one, or more. @pre trials > 0, 0 < chance < 1.
double binomial_p(const Proportion& x, double chance);

/// χ² of whether all share one proportion (Pearson). χ²/df far above 1 is over-dispersion: answers
/// of one participant are alike, so that tests over answers overstate. Nothing with fewer than two,
/// or where all answers are right, or none. @pre trials > 0.
std::optional<TestResult> dispersion(std::span<const Proportion> of);

/// How well a yes/no answer follows the question, of the equal-variance model, with half an answer
/// added to each kind so that all rates have a quantile (Hautus, Behav. Res. Methods 27, 46
/// (1995)).
struct Sensitivity {
  double d_prime = 0.0;  ///< 0: not at all
  double bias = 0.0;     ///< criterion c; below 0: yes too often
};
/// @param hits yes where yes is right. @param false_alarms yes where no is right. @pre trials > 0.
Sensitivity sensitivity(const Proportion& hits, const Proportion& false_alarms);

/// Welch's t, mean of b minus mean of a, unequal variances. Nothing with fewer than two values in a
/// group, or where neither group varies.
std::optional<TestResult> welch_t(std::span<const double> a, std::span<const double> b);
/// t of pairs, mean of b − a. Nothing with fewer than two pairs, or where differences do not vary.
/// @pre as many in a as in b.
std::optional<TestResult> paired_t(std::span<const double> a, std::span<const double> b);

struct Permutation {
  double p = 1.0;
  std::int64_t splits = 0;
  bool exact = true;  ///< all splits; else that many random ones, the observed one added
};
/// Share of the splits of all values into groups of these sizes whose means differ as much as those
/// of a and b, or more. All splits up to kMostSplits, else as many random ones. @pre no group is
/// empty.
Permutation permutation(std::span<const double> a, std::span<const double> b, std::uint64_t seed);
/// The same for pairs: share of the signs of b − a. @pre as many in a as in b, at least one.
Permutation paired_permutation(std::span<const double> a, std::span<const double> b,
                               std::uint64_t seed);
inline constexpr std::int64_t kMostSplits = 200'000;

/// Difference of means over the pooled standard deviation (Cohen's d), b minus a. Nothing where
/// welch_t() is nothing.
std::optional<double> effect_size(std::span<const double> a, std::span<const double> b);
/// Mean difference over the standard deviation of differences. Nothing where paired_t() is nothing.
std::optional<double> paired_effect_size(std::span<const double> a, std::span<const double> b);

/// Whether each participant has one method or all.
enum class Groups : std::uint8_t { Between, Within };
/// Returns the chance that a t test finds an effect of size d, by the noncentral t distribution.
/// @param n participants of a group, or in all when within. @pre n ≥ 2, 0 < alpha < 1.
double t_test_power(double d, int n, Groups groups, double alpha = 0.05);
/// Returns the fewest participants, of a group or in all when within, with at least that power;
/// nothing above 10 000. @pre 0 < power < 1.
std::optional<int> participants_needed(double d, Groups groups, double power = 0.8,
                                       double alpha = 0.05);

}  // namespace prostm
