#include "prostm/study/analysis/effects.hpp"

#include <algorithm>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "prostm/study/task/detail/moments.hpp"

namespace prostm {
namespace {

namespace bm = boost::math;

/// A mean difference with its standard error.
struct Measured {
  double difference = 0.0, error = 0.0, df = 0.0;
};

Measured measured_pairs(const TwoSamples& of) {
  const std::vector<double> change = study::differences(of.a, of.b);
  const auto n = static_cast<double>(change.size());
  return {study::mean(change), std::sqrt(study::squares(change) / (n - 1.0) / n), n - 1.0};
}

/// With Welch's standard error and degrees of freedom.
Measured measured_groups(const TwoSamples& of) {
  const auto n = static_cast<double>(of.a.size()), m = static_cast<double>(of.b.size());
  const double a = study::squares(of.a) / (n - 1.0) / n, b = study::squares(of.b) / (m - 1.0) / m;
  const double df = (a + b) * (a + b) / (a * a / (n - 1.0) + b * b / (m - 1.0));
  return {study::mean(of.b) - study::mean(of.a), std::sqrt(a + b), df};
}

/// @pre the samples vary.
Measured measured(const TwoSamples& of) {
  return of.groups == Groups::Within ? measured_pairs(of) : measured_groups(of);
}

Interval interval_of(const Measured& x, double level) {
  const double half = x.error * bm::quantile(bm::students_t(x.df), 0.5 + 0.5 * level);
  return {x.difference - half, x.difference + half};
}

/// An effect size as a noncentral t value: t = d √n.
struct EffectAsT {
  double d = 0.0, n = 0.0, df = 0.0;
  double t() const { return d * std::sqrt(n); }
};

/// @pre the samples vary.
EffectAsT effect_as_t(const TwoSamples& of) {
  const auto n = static_cast<double>(of.a.size()), m = static_cast<double>(of.b.size());
  if (of.groups == Groups::Within) return {*paired_effect_size(of.a, of.b), n, n - 1.0};
  return {*effect_size(of.a, of.b), n * m / (n + m), n + m - 2.0};
}

/// Returns the noncentrality at which a t value has this cumulative probability, which falls with
/// the noncentrality.
double noncentrality(double t, double df, double share) {
  const auto excess = [&](double shift) {
    return bm::cdf(bm::non_central_t(df, shift), t) - share;
  };
  double low = t, high = t, step = 2.0;
  while (excess(low) < 0.0) low -= step, step *= 2.0;
  step = 2.0;
  while (excess(high) > 0.0) high += step, step *= 2.0;
  if (low == high) return t;
  std::uintmax_t steps = 200;
  const auto [below, above] =
      bm::tools::toms748_solve(excess, low, high, bm::tools::eps_tolerance<double>(48), steps);
  return 0.5 * (below + above);
}

}  // namespace

bool TwoSamples::varies() const {
  return groups == Groups::Within ? paired_t(a, b).has_value() : welch_t(a, b).has_value();
}

std::optional<Estimate> mean_difference(const TwoSamples& of, double level) {
  if (!of.varies()) return std::nullopt;
  const Measured x = measured(of);
  return Estimate{x.difference, interval_of(x, level)};
}

std::optional<Estimate> standardised_difference(const TwoSamples& of, double level) {
  if (!of.varies()) return std::nullopt;
  const EffectAsT effect = effect_as_t(of);
  const double tail = 0.5 * (1.0 - level), scale = 1.0 / std::sqrt(effect.n);
  return Estimate{effect.d,
                  {scale * noncentrality(effect.t(), effect.df, 1.0 - tail),
                   scale * noncentrality(effect.t(), effect.df, tail)}};
}

std::optional<Equivalence> equivalence(const TwoSamples& of, double bound, double alpha) {
  if (!of.varies()) return std::nullopt;
  const Measured x = measured(of);
  const bm::students_t t(x.df);
  Equivalence out;
  out.bound = bound;
  out.p_above_low = bm::cdf(bm::complement(t, (x.difference + bound) / x.error));
  out.p_below_high = bm::cdf(t, (x.difference - bound) / x.error);
  out.interval = interval_of(x, 1.0 - 2.0 * alpha);
  return out;
}

double jzs_bayes_factor(double t, double n, double df, double scale) {
  const double by_none = -0.5 * (df + 1.0) * std::log1p(t * t / df);
  // the prior's variance g is integrated over its logarithm
  const auto log_density = [&](double log_g) {
    const double g = std::exp(log_g), spread = 1.0 + n * g * scale * scale;
    return -0.5 * std::log(spread) - 0.5 * (df + 1.0) * std::log1p(t * t / (spread * df)) -
           by_none - 0.5 * std::log(2.0 * std::numbers::pi) - 0.5 * log_g - 0.5 / g;
  };
  // where the density lies; outside it is below 1e-17 of its peak
  constexpr double kLow = -6.0, kHigh = 50.0, kStep = 0.25;
  double peak = log_density(kLow);
  for (double log_g = kLow; log_g < kHigh; log_g += kStep)
    peak = std::max(peak, log_density(log_g));
  const auto density = [&](double log_g) { return std::exp(log_density(log_g) - peak); };
  using Rule = bm::quadrature::gauss_kronrod<double, 31>;
  constexpr unsigned kDepth = 15;
  constexpr double kError = 1e-12;
  const double log_factor = peak + std::log(Rule::integrate(density, kLow, kHigh, kDepth, kError));
  static const double kLargest = std::log(std::numeric_limits<double>::max());
  return log_factor < kLargest ? std::exp(log_factor) : std::numeric_limits<double>::max();
}

std::optional<double> bayes_factor(const TwoSamples& of, double scale) {
  if (!of.varies()) return std::nullopt;
  const EffectAsT effect = effect_as_t(of);
  return jzs_bayes_factor(effect.t(), effect.n, effect.df, scale);
}

std::vector<double> holm(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  std::vector<double> out(p.size());
  double most = 0.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    most = std::max(most, static_cast<double>(p.size() - i) * p[order[i]]);
    out[order[i]] = std::min(1.0, most);
  }
  return out;
}

}  // namespace prostm
