#include "prostm/study/psychometric.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>

namespace prostm {
namespace {

/// The logarithm of the likelihood of a share of right answers, without the binomial coefficient.
double log_likelihood(const Proportion& correct, double share) {
  constexpr double kLeast = 1e-300;  // keeps the logarithm finite
  const int wrong = correct.trials - correct.successes;
  double sum = 0.0;
  if (correct.successes > 0) sum += correct.successes * std::log(std::max(share, kLeast));
  if (wrong > 0) sum += wrong * std::log(std::max(1.0 - share, kLeast));
  return sum;
}

/// The likelihood of answers as a function of threshold and the logarithm of the slope.
class Likelihood {
 public:
  Likelihood(std::span<const LevelScore> scores, double guess, double lapse)
      : scores_(scores), guess_(guess), lapse_(lapse) {
    const auto [low, high] = std::minmax_element(
        scores.begin(), scores.end(),
        [](const LevelScore& a, const LevelScore& b) { return a.level < b.level; });
    range_ = high->level - low->level;
    first_ = low->level;
  }

  double range() const { return range_; }
  /// Thresholds are looked for a range beyond the levels, slopes from one that hardly grows over
  /// them to one that is a step.
  double lowest_threshold() const { return first_ - range_; }
  double highest_threshold() const { return first_ + 2.0 * range_; }
  double lowest_slope() const { return std::log(0.1 / range_); }
  double highest_slope() const { return std::log(1e3 / range_); }

  Psychometric function(double threshold, double log_slope) const {
    return {threshold, std::exp(log_slope), guess_, lapse_};
  }

  double at(double threshold, double log_slope) const {
    const Psychometric psi = function(threshold, log_slope);
    double sum = 0.0;
    for (const LevelScore& score : scores_)
      sum += log_likelihood(score.correct, psi.at(score.level));
    return sum;
  }

  /// The largest likelihood of a function that jumps from guessing to the most, at one of the
  /// levels, whose own share is then free, or between two.
  double of_best_step() const {
    double best = -HUGE_VAL;
    for (const LevelScore& at : scores_) {
      for (const double free : {guess_, 1.0 - lapse_, at.correct.value()}) {
        const double here = std::clamp(free, guess_, 1.0 - lapse_);
        double sum = 0.0;
        for (const LevelScore& score : scores_) {
          const double right = score.level < at.level   ? guess_
                               : score.level > at.level ? 1.0 - lapse_
                                                        : here;
          sum += log_likelihood(score.correct, right);
        }
        best = std::max(best, sum);
      }
    }
    return best;
  }

  /// The largest likelihood with this threshold, over slopes.
  double over_slopes(double threshold) const {
    return most([&](double s) { return at(threshold, s); }, lowest_slope(), highest_slope());
  }
  /// The largest likelihood with this slope, over thresholds.
  double over_thresholds(double log_slope) const {
    return most([&](double t) { return at(t, log_slope); }, lowest_threshold(),
                highest_threshold());
  }

 private:
  /// The largest value between two ends: a scan, then Brent's method around the best of it.
  template <class F>
  double most(const F& f, double low, double high) const {
    constexpr int kScan = 48, kBits = 40;
    const double step = (high - low) / kScan;
    int best = 0;
    double value = f(low);
    for (int i = 1; i <= kScan; ++i) {
      const double here = f(low + i * step);
      if (here > value) value = here, best = i;
    }
    const double middle = low + best * step;
    const auto found = boost::math::tools::brent_find_minima([&](double x) { return -f(x); },
                                                             std::max(low, middle - step),
                                                             std::min(high, middle + step), kBits);
    return std::max(value, -found.second);
  }

  std::span<const LevelScore> scores_;
  double guess_, lapse_, first_ = 0.0, range_ = 0.0;
};

struct Peak {
  double threshold = 0.0, log_slope = 0.0, value = -HUGE_VAL;
};

/// The best of a grid of thresholds and slopes.
Peak scan(const Likelihood& likelihood) {
  constexpr int kThresholds = 90, kSlopes = 60;
  Peak best;
  for (int i = 0; i <= kThresholds; ++i) {
    for (int j = 0; j <= kSlopes; ++j) {
      const double t = std::lerp(likelihood.lowest_threshold(), likelihood.highest_threshold(),
                                 static_cast<double>(i) / kThresholds),
                   s = std::lerp(likelihood.lowest_slope(), likelihood.highest_slope(),
                                 static_cast<double>(j) / kSlopes);
      const double value = likelihood.at(t, s);
      if (value > best.value) best = {t, s, value};
    }
  }
  return best;
}

/// Climbs by Fisher scoring: the expected curvature, and half the step where that is too far.
Peak climb(const Likelihood& likelihood, std::span<const LevelScore> scores, Peak peak) {
  constexpr int kSteps = 100;
  for (int step = 0; step < kSteps; ++step) {
    const Psychometric psi = likelihood.function(peak.threshold, peak.log_slope);
    const double scale = 1.0 - psi.guess - psi.lapse;
    double gt = 0.0, gs = 0.0, tt = 0.0, ts = 0.0, ss = 0.0;  // gradient and information
    for (const LevelScore& score : scores) {
      const double right = psi.at(score.level), open = (right - psi.guess) / scale;
      const double variance = right * (1.0 - right);
      if (!(variance > 0.0)) continue;
      const double rise = scale * open * (1.0 - open);  // dψ/d(s (x − t))
      const double dt = -psi.slope * rise, ds = psi.slope * (score.level - psi.threshold) * rise;
      const double off = score.correct.successes - score.correct.trials * right;
      gt += off * dt / variance;
      gs += off * ds / variance;
      const double weight = score.correct.trials / variance;
      tt += weight * dt * dt;
      ts += weight * dt * ds;
      ss += weight * ds * ds;
    }
    const double determinant = tt * ss - ts * ts;
    if (!(determinant > 0.0)) break;
    double dt = (ss * gt - ts * gs) / determinant, ds = (tt * gs - ts * gt) / determinant;
    constexpr int kHalvings = 30;
    Peak next;
    for (int half = 0; half < kHalvings; ++half, dt *= 0.5, ds *= 0.5) {
      next = {peak.threshold + dt, peak.log_slope + ds,
              likelihood.at(peak.threshold + dt, peak.log_slope + ds)};
      if (next.value >= peak.value) break;
    }
    if (!(next.value >= peak.value)) break;
    peak = next;
    if (std::abs(dt) < 1e-13 * likelihood.range() && std::abs(ds) < 1e-13) break;
  }
  return peak;
}

/// Where a profile falls to a bound between its peak and an end of the search.
template <class Profile>
std::optional<double> end_of(const Profile& profile, double peak, double end, double bound) {
  const auto above = [&](double x) { return profile(x) - bound; };
  if (above(end) > 0.0) return std::nullopt;
  const double low = std::min(peak, end), high = std::max(peak, end);
  constexpr std::uintmax_t kSteps = 200;
  std::uintmax_t steps = kSteps;
  const auto found = boost::math::tools::bisect(
      above, low, high, boost::math::tools::eps_tolerance<double>(36), steps);
  return 0.5 * (found.first + found.second);
}

/// Both of them.
template <class Profile>
std::optional<Interval> interval(const Profile& profile, double peak, double low, double high,
                                 double bound) {
  const auto from = end_of(profile, peak, low, bound), to = end_of(profile, peak, high, bound);
  if (!from || !to) return std::nullopt;
  return Interval{*from, *to};
}

}  // namespace

double Psychometric::at(double level) const {
  constexpr double kFar = 700.0;  // of the exponential function
  const double x = std::clamp(slope * (level - threshold), -kFar, kFar);
  return guess + (1.0 - guess - lapse) / (1.0 + std::exp(-x));
}

std::optional<PsychometricFit> fit_psychometric(std::span<const LevelScore> scores, double guess,
                                                double lapse, double level, NoFit* why) {
  const auto none = [&](NoFit reason) {
    if (why != nullptr) *why = reason;
    return std::nullopt;
  };
  if (scores.size() < 2) return none(NoFit::TooFewLevels);
  const Likelihood likelihood(scores, guess, lapse);
  if (!(likelihood.range() > 0.0)) return none(NoFit::TooFewLevels);
  const double share = scores.front().correct.value();
  const auto is_same = [&](const LevelScore& x) { return x.correct.value() == share; };
  if (std::all_of(scores.begin(), scores.end(), is_same)) return none(NoFit::NotGrowing);
  const Peak peak = climb(likelihood, scores, scan(likelihood));
  // a step that fits as well as any slope: the likelihood only grows with the slope
  constexpr double kAsWell = 1e-6;
  if (likelihood.of_best_step() > peak.value - kAsWell) return none(NoFit::Step);
  const bool inside = peak.threshold > likelihood.lowest_threshold() &&
                      peak.threshold < likelihood.highest_threshold() &&
                      peak.log_slope > likelihood.lowest_slope() &&
                      peak.log_slope < likelihood.highest_slope();
  if (!inside) return none(NoFit::NotGrowing);
  const double bound =
      peak.value - 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), level);
  const auto of_threshold = [&](double t) { return likelihood.over_slopes(t); };
  const auto of_slope = [&](double s) { return likelihood.over_thresholds(s); };
  const auto threshold = interval(of_threshold, peak.threshold, likelihood.lowest_threshold(),
                                  likelihood.highest_threshold(), bound);
  auto slope = interval(of_slope, peak.log_slope, likelihood.lowest_slope(),
                        likelihood.highest_slope(), bound);
  if (slope) slope = Interval{std::exp(slope->low), std::exp(slope->high)};
  return PsychometricFit{likelihood.function(peak.threshold, peak.log_slope), threshold, slope,
                         peak.value};
}

}  // namespace prostm
