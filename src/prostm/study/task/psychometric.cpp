#include "prostm/study/task/psychometric.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "prostm/core/random.hpp"

namespace prostm {
namespace {

/// Log-likelihood of a share of right answers, without the binomial coefficient.
double log_likelihood(const Proportion& correct, double share) {
  constexpr double kLeast = 1e-300;  // keeps the logarithm finite
  const int wrong = correct.trials - correct.successes;
  double sum = 0.0;
  if (correct.successes > 0) sum += correct.successes * std::log(std::max(share, kLeast));
  if (wrong > 0) sum += wrong * std::log(std::max(1.0 - share, kLeast));
  return sum;
}

/// A function that jumps from the lower to the upper asymptote.
struct Step {
  double value = -HUGE_VAL;  // its log-likelihood
  Interval between;          // the levels between which it jumps; if equal, it jumps at that level
};

/// Log-likelihood of answers as a function of threshold and log slope. A lapse rate that is not
/// given is maximised over.
class Likelihood {
 public:
  /// @param scores by level, ascending.
  Likelihood(std::span<const LevelScore> scores, const PsychometricSettings& settings)
      : scores_(scores),
        guess_(settings.guess),
        lapse_(settings.lapse),
        range_(scores.back().level - scores.front().level),
        first_(scores.front().level) {}

  double range() const { return range_; }
  std::span<const LevelScore> scores() const { return scores_; }
  /// Search bounds: thresholds up to one range beyond the levels, slopes from nearly flat over the
  /// levels to a step.
  double lowest_threshold() const { return first_ - range_; }
  double highest_threshold() const { return first_ + 2.0 * range_; }
  double lowest_slope() const { return std::log(0.1 / range_); }
  double highest_slope() const { return std::log(1e3 / range_); }
  bool fits_lapse() const { return !lapse_; }

  Psychometric function(double threshold, double log_slope) const {
    Psychometric psi{threshold, std::exp(log_slope), guess_, lapse_.value_or(0.0)};
    if (!lapse_) psi.lapse = best_lapse(psi);
    return psi;
  }

  double at(double threshold, double log_slope) const {
    const Psychometric psi = function(threshold, log_slope);
    double sum = 0.0;
    for (const LevelScore& score : scores_)
      sum += log_likelihood(score.correct, psi.at(score.level));
    return sum;
  }

  /// The maximum-likelihood step: between two levels, beyond all levels, or at a level, whose share
  /// is then a free parameter.
  Step best_step() const {
    Step best;
    const std::size_t n = scores_.size();
    const auto level = [&](std::size_t i) { return scores_[i].level; };
    for (std::size_t i = 0; i <= n; ++i) {
      const double value = step(i, n);
      if (value <= best.value) continue;
      best = {value, {i == 0 ? -HUGE_VAL : level(i - 1), i == n ? HUGE_VAL : level(i)}};
    }
    constexpr double kBetter = 1e-9;
    for (std::size_t i = 0; i < n; ++i) {
      const double value = step(i, i);
      if (value > best.value + kBetter) best = {value, {level(i), level(i)}};
    }
    return best;
  }

  /// Profile likelihood of a threshold: the maximum over slopes.
  double over_slopes(double threshold) const {
    return most([&](double s) { return at(threshold, s); }, lowest_slope(), highest_slope());
  }
  /// Profile likelihood of a slope: the maximum over thresholds.
  double over_thresholds(double log_slope) const {
    return most([&](double t) { return at(t, log_slope); }, lowest_threshold(),
                highest_threshold());
  }

 private:
  /// Log-likelihood of a step before level `first`. @param free the level whose share is free, if
  /// any.
  double step(std::size_t first, std::size_t free) const {
    Proportion above;
    for (std::size_t i = first; i < scores_.size(); ++i) {
      if (i == free) continue;
      above.successes += scores_[i].correct.successes;
      above.trials += scores_[i].correct.trials;
    }
    const double missing = above.trials > 0 ? 1.0 - above.value() : 0.0;
    const double lapse = lapse_.value_or(std::min(missing, kMostLapse));
    double sum = 0.0;
    for (std::size_t i = 0; i < scores_.size(); ++i) {
      const double share = i < first ? guess_ : 1.0 - lapse, own = scores_[i].correct.value();
      sum += log_likelihood(scores_[i].correct,
                            i == free ? std::clamp(own, guess_, 1.0 - lapse) : share);
    }
    return sum;
  }

  /// The maximum-likelihood lapse rate. The likelihood is concave in it: Newton's method, with
  /// bisection where a step leaves the bounds.
  double best_lapse(const Psychometric& psi) const {
    constexpr double kLeast = 1e-12;  // keeps quotients finite
    const auto slopes = [&](double lapse) {
      double first = 0.0, second = 0.0;
      Psychometric with = psi;
      with.lapse = lapse;
      for (const LevelScore& score : scores_) {
        const double right = with.at(score.level);
        const double open = (right - guess_) / (1.0 - guess_ - lapse);
        const double hits = score.correct.successes / std::max(right, kLeast),
                     misses = (score.correct.trials - score.correct.successes) /
                              std::max(1.0 - right, kLeast);
        first += open * (misses - hits);
        second -=
            open * open * (hits / std::max(right, kLeast) + misses / std::max(1.0 - right, kLeast));
      }
      return std::pair(first, second);
    };
    double low = 0.0, high = kMostLapse;
    if (slopes(low).first <= 0.0) return low;
    if (slopes(high).first >= 0.0) return high;
    double lapse = 0.5 * high;
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps; ++i) {
      const auto [first, second] = slopes(lapse);
      (first > 0.0 ? low : high) = lapse;
      const double newton = second < 0.0 ? lapse - first / second : low;
      const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
      const double moved = std::abs(next - lapse);
      lapse = next;
      if (moved < 1e-13) break;
    }
    return lapse;
  }

  /// The maximum between two ends: a scan, then Brent's method around the best point.
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
  double guess_;
  std::optional<double> lapse_;
  double range_, first_;
};

struct Peak {
  double threshold = 0.0, log_slope = 0.0, value = -HUGE_VAL;
};

/// The best point of a grid of thresholds and slopes.
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

/// A step towards the maximum likelihood, in threshold and log slope.
struct Move {
  double threshold = 0.0, log_slope = 0.0;
};

/// One step of Fisher scoring: the gradient over the expected curvature. A fitted lapse rate
/// depends on both parameters, and the curvature accounts for this. Nothing if the curvature
/// vanishes.
std::optional<Move> fisher_step(const Likelihood& likelihood, const Peak& peak) {
  const Psychometric psi = likelihood.function(peak.threshold, peak.log_slope);
  const double scale = 1.0 - psi.guess - psi.lapse;
  double gt = 0.0, gs = 0.0, tt = 0.0, ts = 0.0, ss = 0.0;  // gradient and information
  double tl = 0.0, sl = 0.0, ll = 0.0;                      // information on the lapse rate
  for (const LevelScore& score : likelihood.scores()) {
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
    tl -= weight * dt * open;
    sl -= weight * ds * open;
    ll += weight * open * open;
  }
  if (likelihood.fits_lapse() && psi.lapse > 0.0 && psi.lapse < kMostLapse && ll > 0.0) {
    tt -= tl * tl / ll;
    ts -= tl * sl / ll;
    ss -= sl * sl / ll;
  }
  const double determinant = tt * ss - ts * ts;
  if (!(determinant > 0.0)) return std::nullopt;
  return Move{(ss * gt - ts * gs) / determinant, (tt * gs - ts * gt) / determinant};
}

/// Climbs by Fisher scoring, halving steps that overshoot.
Peak climb(const Likelihood& likelihood, Peak peak) {
  constexpr int kSteps = 100, kHalvings = 30;
  for (int step = 0; step < kSteps; ++step) {
    auto move = fisher_step(likelihood, peak);
    if (!move) break;
    Peak next;
    for (int half = 0; half < kHalvings; ++half) {
      const double t = peak.threshold + move->threshold, s = peak.log_slope + move->log_slope;
      next = {t, s, likelihood.at(t, s)};
      if (next.value >= peak.value) break;
      move->threshold *= 0.5;
      move->log_slope *= 0.5;
    }
    if (!(next.value >= peak.value)) break;
    peak = next;
    if (std::abs(move->threshold) < 1e-13 * likelihood.range() && std::abs(move->log_slope) < 1e-13)
      break;
  }
  return peak;
}

/// The point between a profile's peak and an end of the search where the profile falls to a bound.
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

/// Both ends of the interval; an unbounded end is infinite.
template <class Profile>
Interval interval(const Profile& profile, double peak, double low, double high, double bound) {
  if (!(profile(peak) > bound)) return {-HUGE_VAL, HUGE_VAL};
  return {end_of(profile, peak, low, bound).value_or(-HUGE_VAL),
          end_of(profile, peak, high, bound).value_or(HUGE_VAL)};
}

bool is_open(double end) {
  return std::isinf(end);
}

double fall_at(double level) {
  return 0.5 * boost::math::quantile(boost::math::chi_squared(1.0), level);
}

/// The thresholds whose profile likelihood is close to `most`.
Interval threshold_interval(const Likelihood& likelihood, double threshold, double most,
                            double level) {
  const double low = likelihood.lowest_threshold(), high = likelihood.highest_threshold();
  return interval([&](double t) { return likelihood.over_slopes(t); },
                  std::clamp(threshold, low, high), low, high, most - fall_at(level));
}

/// Cochran and Armitage's test of a trend of shares over levels, as a standard normal value; 0
/// where all answers are right, or none.
double trend(std::span<const LevelScore> scores) {
  double right = 0.0, all = 0.0, mean = 0.0;
  for (const LevelScore& score : scores) {
    right += score.correct.successes;
    all += score.correct.trials;
    mean += score.correct.trials * score.level;
  }
  mean /= all;
  double sum = 0.0, squares = 0.0;
  for (const LevelScore& score : scores) {
    sum += score.correct.successes * (score.level - mean);
    squares += score.correct.trials * (score.level - mean) * (score.level - mean);
  }
  const double variance = right / all * (1.0 - right / all) * squares;
  return variance > 0.0 ? sum / std::sqrt(variance) : 0.0;
}

/// Bounds from answers at one level, by whether their share is above or below the share at the
/// threshold.
PsychometricResult at_one_level(std::span<const LevelScore> scores,
                                const PsychometricSettings& settings) {
  PsychometricResult out;
  Proportion all;
  for (const LevelScore& score : scores) {
    all.successes += score.correct.successes;
    all.trials += score.correct.trials;
  }
  const double most = 1.0 - settings.lapse.value_or(0.0), half = 0.5 * (settings.guess + most);
  const double share = std::clamp(all.value(), settings.guess, most);
  const double fallen = log_likelihood(all, share) - log_likelihood(all, half);
  if (!(fallen > fall_at(settings.level))) return out;
  const Interval beyond = share > half ? Interval{-HUGE_VAL, scores.front().level}
                                       : Interval{scores.front().level, HUGE_VAL};
  out.bounds = ThresholdBounds{beyond, beyond};
  return out;
}

/// The reason why there is no fit, and the remaining bounds. @param best bounds of the step, if a
/// step fits as well as any slope.
PsychometricResult without_fit(const Likelihood& likelihood, const std::optional<Interval>& best,
                               const Interval& found) {
  PsychometricResult out;
  const auto scores = likelihood.scores();
  // the steepest slope of the search is not quite a step, so its interval ends short of a level
  const auto bounds = [&](const Interval& of) {
    return ThresholdBounds{of, {std::min(of.low, found.low), std::max(of.high, found.high)}};
  };
  out.no_fit = NoFit::NotGrowing;
  if (best && !is_open(best->low) && !is_open(best->high)) {
    out.no_fit = NoFit::Step;
    out.bounds = bounds(*best);
  } else if (is_open(found.low) && !is_open(found.high)) {
    out.no_fit = NoFit::BelowLevels;
    out.bounds = bounds({-HUGE_VAL, scores.front().level});
  } else if (!is_open(found.low) && is_open(found.high)) {
    out.no_fit = NoFit::AboveLevels;
    out.bounds = bounds({scores.back().level, HUGE_VAL});
  }
  return out;
}

double deviance_of(const Likelihood& likelihood, double value) {
  double saturated = 0.0;
  for (const LevelScore& score : likelihood.scores())
    saturated += log_likelihood(score.correct, score.correct.value());
  return std::max(0.0, 2.0 * (saturated - value));
}

/// Tests a fit against fits to answers drawn from it, until enough of these have as large a
/// deviance.
std::optional<Misfit> misfit_of(const Likelihood& likelihood, const Peak& peak,
                                const PsychometricSettings& settings) {
  constexpr int kEnough = 10, kMost = 400;
  constexpr double kTie = 1e-9;  // between deviances that are equal up to rounding
  const int parameters = settings.lapse ? 2 : 3;
  Misfit out;
  out.df = static_cast<int>(likelihood.scores().size()) - parameters;
  if (out.df <= 0) return std::nullopt;
  out.deviance = deviance_of(likelihood, peak.value);
  const Psychometric psi = likelihood.function(peak.threshold, peak.log_slope);
  const std::vector<LevelScore> real(likelihood.scores().begin(), likelihood.scores().end());
  Random random(settings.seed);
  int as_far = 0, drawn = 0;
  for (; drawn < kMost && as_far < kEnough; ++drawn) {
    std::vector<LevelScore> scores = real;
    for (LevelScore& score : scores) {
      const double right = psi.at(score.level);
      score.correct.successes = 0;
      for (int i = 0; i < score.correct.trials; ++i)
        score.correct.successes += random.uniform() < right ? 1 : 0;
    }
    const Likelihood of_drawn(scores, settings);
    Peak start = peak;
    start.value = of_drawn.at(peak.threshold, peak.log_slope);
    const double best = std::max(climb(of_drawn, start).value, of_drawn.best_step().value);
    as_far += deviance_of(of_drawn, best) >= out.deviance - kTie ? 1 : 0;
  }
  out.p = as_far == kEnough ? static_cast<double>(as_far) / drawn : (as_far + 1.0) / (drawn + 1.0);
  return out;
}

}  // namespace

double Psychometric::at(double level) const {
  constexpr double kFar = 700.0;  // largest argument of the exponential function
  const double x = std::clamp(slope * (level - threshold), -kFar, kFar);
  return guess + (1.0 - guess - lapse) / (1.0 + std::exp(-x));
}

PsychometricResult fit_psychometric(std::span<const LevelScore> given,
                                    const PsychometricSettings& settings) {
  std::vector<LevelScore> scores(given.begin(), given.end());
  std::sort(scores.begin(), scores.end(),
            [](const LevelScore& a, const LevelScore& b) { return a.level < b.level; });
  if (scores.empty()) return {};
  if (!(scores.back().level > scores.front().level)) return at_one_level(scores, settings);
  constexpr double kFalls = -1.96;
  PsychometricResult out;
  out.no_fit = NoFit::Falling;
  if (trend(scores) < kFalls) return out;
  const Likelihood likelihood(scores, settings);
  const Peak peak = climb(likelihood, scan(likelihood));
  const Step step = likelihood.best_step();
  // a step that fits as well as any slope: the likelihood only grows with the slope
  constexpr double kAsWell = 1e-6;
  const bool is_step = step.value > peak.value - kAsWell;
  const Interval threshold = threshold_interval(likelihood, peak.threshold,
                                                std::max(peak.value, step.value), settings.level);
  const bool inside = peak.threshold > likelihood.lowest_threshold() &&
                      peak.threshold < likelihood.highest_threshold() &&
                      peak.log_slope > likelihood.lowest_slope() &&
                      peak.log_slope < likelihood.highest_slope();
  if (is_step || !inside) {
    return without_fit(likelihood, is_step ? std::optional(step.between) : std::nullopt, threshold);
  }
  const auto of_slope = [&](double s) { return likelihood.over_thresholds(s); };
  const Interval slope = interval(of_slope, peak.log_slope, likelihood.lowest_slope(),
                                  likelihood.highest_slope(), peak.value - fall_at(settings.level));
  PsychometricFit& fit = out.fit.emplace();
  fit.function = likelihood.function(peak.threshold, peak.log_slope);
  if (!is_open(threshold.low) || !is_open(threshold.high)) fit.threshold = threshold;
  if (!is_open(slope.low) && !is_open(slope.high))
    fit.slope = Interval{std::exp(slope.low), std::exp(slope.high)};
  fit.log_likelihood = peak.value;
  fit.misfit = misfit_of(likelihood, peak, settings);
  return out;
}

}  // namespace prostm
