#pragma once
/// Statistics of right and wrong answers. All tests are two-sided. Distributions come from
/// Boost.Math.

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
/// Returns Wilson's interval of a proportion (J. Am. Stat. Assoc. 22, 209 (1927)), which is
/// accurate for few trials and near 0 and 1, too. @param level of confidence, 0..1, e.g. 0.95. @pre
/// trials > 0.
Interval wilson_interval(const Proportion& x, double level = 0.95);

struct TestResult {
  double statistic = 0.0;
  double df = 0.0;  ///< degrees of freedom; 0 if the test has none
  double p = 1.0;
};
/// z test of two proportions with pooled variance, b minus a. Assumes independent answers. Returns
/// 0 with p = 1 if all answers are right, or none is. @pre trials > 0.
TestResult two_proportions_z(const Proportion& a, const Proportion& b);
/// p of Fisher's exact test on the 2 × 2 table of right and wrong answers: the probability of all
/// tables at most as likely as this one. @pre trials > 0.
double fisher_exact_p(const Proportion& a, const Proportion& b);
/// p of the exact binomial test against guessing: the probability of all counts at most as likely
/// as this one. @param chance share of right answers when guessing. @pre trials > 0, 0 < chance <
/// 1.
double binomial_p(const Proportion& x, double chance);

/// Pearson's χ² test of equal proportions. χ²/df far above 1 is overdispersion: answers of one
/// participant are correlated, so tests over answers overstate significance. Nothing with fewer
/// than two proportions, or if all answers are right, or none is. @pre trials > 0.
std::optional<TestResult> dispersion(std::span<const Proportion> of);

/// Sensitivity and bias of yes/no answers in the equal-variance model, with the log-linear
/// correction: half an answer is added to each cell so that every rate has a finite quantile
/// (Hautus, Behav. Res. Methods 27, 46 (1995)).
struct Sensitivity {
  double d_prime = 0.0;  ///< 0: at chance
  double bias = 0.0;     ///< criterion c; negative: biased towards yes
};
/// @param hits yes answers where yes is right. @param false_alarms yes answers where no is right.
/// @pre trials > 0.
Sensitivity sensitivity(const Proportion& hits, const Proportion& false_alarms);

/// Welch's t test, mean of b minus mean of a, unequal variances. Nothing with fewer than two values
/// in a group, or if neither group varies.
std::optional<TestResult> welch_t(std::span<const double> a, std::span<const double> b);
/// Paired t test, mean of b − a. Nothing with fewer than two pairs, or if all differences are
/// equal. @pre a and b have the same size.
std::optional<TestResult> paired_t(std::span<const double> a, std::span<const double> b);

struct Permutation {
  double p = 1.0;
  std::int64_t splits = 0;
  bool exact = true;  ///< all splits were counted; otherwise random ones, plus the observed one
};
/// Permutation test: the share of splits of all values into groups of these sizes whose means
/// differ at least as much as those of a and b. All splits if there are at most kMostSplits,
/// otherwise that many random ones. @pre no group is empty.
Permutation permutation(std::span<const double> a, std::span<const double> b, std::uint64_t seed);
/// The same for pairs, with random signs of b − a. @pre a and b have the same size, at least 1.
Permutation paired_permutation(std::span<const double> a, std::span<const double> b,
                               std::uint64_t seed);
inline constexpr std::int64_t kMostSplits = 200'000;

/// Cohen's d: difference of means, b minus a, over the pooled standard deviation. Nothing if
/// welch_t() returns nothing.
std::optional<double> effect_size(std::span<const double> a, std::span<const double> b);
/// Mean difference over the standard deviation of differences. Nothing if paired_t() returns
/// nothing.
std::optional<double> paired_effect_size(std::span<const double> a, std::span<const double> b);

/// People who answer, in a group of a study.
struct AnsweringGroup {
  int people = 0, answers = 0;  ///< number of people, and of answers of each
  double share = 0.5;           ///< mean share of right answers
  /// ρ of two answers of a person: shares of people have a beta distribution with the variance
  /// ρ p (1 − p).
  double correlation = 0.1;
};
/// Returns the probability that of two such groups, the second has at least `lead` more right
/// answers, exactly. @pre numbers and lead ≥ 1, 0 < share < 1, 0 < correlation < 1.
double chance_of_lead(const AnsweringGroup& group, int lead);

/// Whether each participant has one method or all.
enum class Groups : std::uint8_t { Between, Within };

}  // namespace prostm
