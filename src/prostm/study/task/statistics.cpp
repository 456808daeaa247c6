#include "prostm/study/task/statistics.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "prostm/core/random.hpp"
#include "prostm/study/task/detail/moments.hpp"

namespace prostm {
namespace {

namespace bm = boost::math;
using study::differences, study::mean, study::squares, study::sum_of, study::varies;

constexpr double kTie = 1e-7;  // relative difference below which probabilities count as equal

double two_sided_p(double t, double df) {
  return std::min(1.0, 2.0 * bm::cdf(bm::complement(bm::students_t(df), std::abs(t))));
}

/// C(n, k), or more than kMostSplits.
std::int64_t splits_of(std::size_t n, std::size_t k) {
  std::int64_t count = 1;
  k = std::min(k, n - k);
  for (std::size_t i = 1; i <= k && count <= kMostSplits; ++i)
    count = count * static_cast<std::int64_t>(n - k + i) / static_cast<std::int64_t>(i);
  return count;
}

/// Counts how often a sum is at least as far from its mean as the observed one.
class Tally {
 public:
  Tally(double observed, double middle, double scale)
      : middle_(middle), bound_(std::abs(observed - middle) - 1e-9 * scale) {}
  void add(double sum) {
    ++all_;
    as_far_ += std::abs(sum - middle_) >= bound_ ? 1 : 0;
  }
  Permutation exact() const {
    return {static_cast<double>(as_far_) / static_cast<double>(all_), all_, true};
  }
  Permutation sampled() const {
    return {static_cast<double>(as_far_ + 1) / static_cast<double>(all_ + 1), all_, false};
  }

 private:
  double middle_, bound_;
  std::int64_t all_ = 0, as_far_ = 0;
};

/// Integers from low to high.
struct Range {
  int low, high;
};

/// Returns the probability of all values of a unimodal distribution that are at most as likely as
/// `observed`. Weights follow from the mode outwards by P(k + 1) = P(k) ratio(k): one product for
/// each value, with an error of a few roundings per step.
/// @param most_likely the mode is the whole number below.
template <typename Ratio>
double as_unlikely_p(Range range, double most_likely, int observed, const Ratio& ratio) {
  const int mode = std::clamp(static_cast<int>(most_likely), range.low, range.high);
  std::vector<double> weights(static_cast<std::size_t>(range.high - range.low) + 1);
  const auto weight = [&](int k) -> double& {
    return weights[static_cast<std::size_t>(k - range.low)];
  };
  weight(mode) = 1.0;
  for (int k = mode; k < range.high; ++k) weight(k + 1) = weight(k) * ratio(k);
  for (int k = mode; k > range.low; --k) weight(k - 1) = weight(k) / ratio(k - 1);
  const double bound = weight(observed) * (1.0 + kTie);
  double as_unlikely = 0.0;
  for (const double w : weights) as_unlikely += w <= bound ? w : 0.0;
  return std::min(1.0, as_unlikely / sum_of(weights));
}

/// Probabilities of 0, 1, … right answers of a person.
std::vector<double> beta_binomial(const AnsweringGroup& of) {
  const double sum = (1.0 - of.correlation) / of.correlation;
  const double a = sum * of.share, b = sum * (1.0 - of.share);
  const auto log_beta = [](double x, double y) {
    return std::lgamma(x) + std::lgamma(y) - std::lgamma(x + y);
  };
  std::vector<double> out;
  for (int k = 0; k <= of.answers; ++k) {
    const double log_choices =
        -log_beta(k + 1.0, of.answers - k + 1.0) - std::log(of.answers + 1.0);
    out.push_back(std::exp(log_choices + log_beta(k + a, of.answers - k + b) - log_beta(a, b)));
  }
  return out;
}

/// Distribution of the sum of two independent counts.
std::vector<double> convolution(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < b.size(); ++k) out[i + k] += a[i] * b[k];
  }
  return out;
}

}  // namespace

Interval wilson_interval(const Proportion& x, double level) {
  const double z = bm::quantile(bm::complement(bm::normal(), 0.5 * (1.0 - level)));
  const double n = x.trials, share = x.value(), stretch = 1.0 + z * z / n;
  const double middle = (share + 0.5 * z * z / n) / stretch;
  const double half = z / stretch * std::sqrt(share * (1.0 - share) / n + 0.25 * z * z / (n * n));
  return {std::max(0.0, middle - half), std::min(1.0, middle + half)};
}

TestResult two_proportions_z(const Proportion& a, const Proportion& b) {
  const double pooled =
      static_cast<double>(a.successes + b.successes) / static_cast<double>(a.trials + b.trials);
  const double variance = pooled * (1.0 - pooled) * (1.0 / a.trials + 1.0 / b.trials);
  if (variance == 0.0) return {};
  const double z = (b.value() - a.value()) / std::sqrt(variance);
  return {z, 0.0, std::min(1.0, 2.0 * bm::cdf(bm::complement(bm::normal(), std::abs(z))))};
}

double fisher_exact_p(const Proportion& a, const Proportion& b) {
  const int right = a.successes + b.successes, all = a.trials + b.trials;
  const double most_likely = (right + 1.0) * (a.trials + 1.0) / (all + 2.0);
  const auto ratio = [&](int k) {
    const double down = (k + 1.0) * (all - right - a.trials + k + 1.0);
    return static_cast<double>(right - k) * (a.trials - k) / down;
  };
  return as_unlikely_p({std::max(0, right - b.trials), std::min(right, a.trials)}, most_likely,
                       a.successes, ratio);
}

double binomial_p(const Proportion& x, double chance) {
  const auto ratio = [&](int k) { return (x.trials - k) * chance / ((k + 1.0) * (1.0 - chance)); };
  return as_unlikely_p({0, x.trials}, (x.trials + 1.0) * chance, x.successes, ratio);
}

std::optional<TestResult> dispersion(std::span<const Proportion> of) {
  int right = 0, all = 0;
  for (const Proportion& x : of) right += x.successes, all += x.trials;
  if (of.size() < 2 || right == 0 || right == all) return std::nullopt;
  const double share = static_cast<double>(right) / all;
  double chi = 0.0;
  for (const Proportion& x : of) {
    const double off = x.successes - x.trials * share;
    chi += off * off / (x.trials * share * (1.0 - share));
  }
  const auto df = static_cast<double>(of.size() - 1);
  if (chi == 0.0) return TestResult{0.0, df, 1.0};
  return TestResult{chi, df, bm::cdf(bm::complement(bm::chi_squared(df), chi))};
}

Sensitivity sensitivity(const Proportion& hits, const Proportion& false_alarms) {
  const auto z = [](const Proportion& x) {
    return bm::quantile(bm::normal(), (x.successes + 0.5) / (x.trials + 1.0));
  };
  return {z(hits) - z(false_alarms), -0.5 * (z(hits) + z(false_alarms))};
}

std::optional<TestResult> welch_t(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 2 || b.size() < 2 || (!varies(a) && !varies(b))) return std::nullopt;
  const auto n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  const double of_a = squares(a) / (n - 1.0) / n, of_b = squares(b) / (m - 1.0) / m;
  const double df =
      (of_a + of_b) * (of_a + of_b) / (of_a * of_a / (n - 1.0) + of_b * of_b / (m - 1.0));
  const double t = (mean(b) - mean(a)) / std::sqrt(of_a + of_b);
  return TestResult{t, df, two_sided_p(t, df)};
}

std::optional<TestResult> paired_t(std::span<const double> a, std::span<const double> b) {
  const std::vector<double> change = differences(a, b);
  if (change.size() < 2 || !varies(change)) return std::nullopt;
  const auto n = static_cast<double>(change.size());
  const double t = mean(change) / std::sqrt(squares(change) / (n - 1.0) / n);
  return TestResult{t, n - 1.0, two_sided_p(t, n - 1.0)};
}

Permutation permutation(std::span<const double> a, std::span<const double> b, std::uint64_t seed) {
  std::vector<double> all(a.begin(), a.end());
  all.insert(all.end(), b.begin(), b.end());
  double scale = 0.0;
  for (const double v : all) scale += std::abs(v);
  // with fixed group sizes, the difference of means is proportional to the deviation of one group's
  // sum from its mean
  const auto size = static_cast<double>(a.size());
  Tally tally(sum_of(a), sum_of(all) * size / static_cast<double>(all.size()), scale);
  if (splits_of(all.size(), a.size()) <= kMostSplits) {
    std::vector<char> chosen(all.size(), 0);
    std::fill_n(chosen.begin(), a.size(), 1);
    do {
      double sum = 0.0;
      for (std::size_t i = 0; i < all.size(); ++i) sum += chosen[i] != 0 ? all[i] : 0.0;
      tally.add(sum);
    } while (std::prev_permutation(chosen.begin(), chosen.end()));
    return tally.exact();
  }
  Random random(seed);
  for (std::int64_t split = 0; split < kMostSplits; ++split) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto left = static_cast<int>(all.size() - i);
      std::swap(all[i], all[i + static_cast<std::size_t>(random.below(left))]);
    }
    tally.add(sum_of(std::span(all).first(a.size())));
  }
  return tally.sampled();
}

Permutation paired_permutation(std::span<const double> a, std::span<const double> b,
                               std::uint64_t seed) {
  const std::vector<double> change = differences(a, b);
  double scale = 0.0;
  for (const double v : change) scale += std::abs(v);
  Tally tally(sum_of(change), 0.0, scale);
  const auto signed_sum = [&](auto&& is_turned) {
    double sum = 0.0;
    for (std::size_t i = 0; i < change.size(); ++i) sum += is_turned(i) ? -change[i] : change[i];
    return sum;
  };
  constexpr std::size_t kMostPairs = 17;  // 2^17 < kMostSplits < 2^18
  if (change.size() <= kMostPairs) {
    for (std::uint32_t signs = 0; signs < std::uint32_t{1} << change.size(); ++signs)
      tally.add(signed_sum([&](std::size_t i) { return (signs >> i & 1U) != 0; }));
    return tally.exact();
  }
  Random random(seed);
  for (std::int64_t split = 0; split < kMostSplits; ++split)
    tally.add(signed_sum([&](std::size_t) { return random.below(2) == 1; }));
  return tally.sampled();
}

std::optional<double> effect_size(std::span<const double> a, std::span<const double> b) {
  if (!welch_t(a, b)) return std::nullopt;
  const auto df = static_cast<double>(a.size() + b.size() - 2);
  return (mean(b) - mean(a)) / std::sqrt((squares(a) + squares(b)) / df);
}

std::optional<double> paired_effect_size(std::span<const double> a, std::span<const double> b) {
  if (!paired_t(a, b)) return std::nullopt;
  const std::vector<double> change = differences(a, b);
  return mean(change) / std::sqrt(squares(change) / static_cast<double>(change.size() - 1));
}

double chance_of_lead(const AnsweringGroup& group, int lead) {
  const std::vector<double> person = beta_binomial(group);
  std::vector<double> right = {1.0};
  for (int i = 0; i < group.people; ++i) right = convolution(right, person);
  double chance = 0.0;
  for (std::size_t first = 0; first < right.size(); ++first) {
    for (std::size_t second = first + static_cast<std::size_t>(lead); second < right.size();
         ++second)
      chance += right[first] * right[second];
  }
  return chance;
}

}  // namespace prostm
