#include "prostm/study/analysis/bradley_terry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/analysis/analysis.hpp"
#include "prostm/study/analysis/effects.hpp"

namespace prostm {
namespace {

namespace bm = boost::math;
using Eigen::Index;

std::string quoted(const std::string& name) {
  return '"' + shown_name(name) + '"';
}

/// Place of a name in the list, to which it is added if needed.
Index place_of(const std::string& name, std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return found - names.begin();
  names.push_back(name);
  return std::ssize(names) - 1;
}

/// wins(i, k): times that i was preferred to k.
Eigen::MatrixXd wins_of(std::span<const PairedComparison> comparisons,
                        std::vector<std::string>& stimuli) {
  for (const PairedComparison& x : comparisons) {
    if (x.a == x.b) throw InputError("the stimulus " + quoted(x.a) + " is compared with itself");
    place_of(x.a, stimuli);
    place_of(x.b, stimuli);
  }
  const auto k = std::ssize(stimuli);
  Eigen::MatrixXd wins = Eigen::MatrixXd::Zero(k, k);
  for (const PairedComparison& x : comparisons) {
    const Index a = place_of(x.a, stimuli), b = place_of(x.b, stimuli);
    using Preferred = PairedComparison::Preferred;
    const double of_a = x.preferred == Preferred::A ? 1.0 : x.preferred == Preferred::B ? 0.0 : 0.5;
    wins(a, b) += of_a;
    wins(b, a) += 1.0 - of_a;
  }
  return wins;
}

/// The stimuli that beat `from` directly or through others, and itself.
std::vector<bool> that_beat(Index from, const Eigen::MatrixXd& wins) {
  std::vector<bool> reached(static_cast<std::size_t>(wins.rows()), false);
  std::vector<Index> open = {from};
  reached[static_cast<std::size_t>(from)] = true;
  while (!open.empty()) {
    const Index at = open.back();
    open.pop_back();
    for (Index i = 0; i < wins.rows(); ++i) {
      if (reached[static_cast<std::size_t>(i)] || wins(i, at) == 0.0) continue;
      reached[static_cast<std::size_t>(i)] = true;
      open.push_back(i);
    }
  }
  return reached;
}

/// Abilities are finite if every stimulus beats every other directly or through others (Ford, Am.
/// Math. Mon. 64, 28 (1957)). @throws InputError: they are not.
void require_finite(const Eigen::MatrixXd& wins, const std::vector<std::string>& stimuli) {
  for (Index i = 0; i < wins.rows(); ++i) {
    const std::vector<bool> above = that_beat(i, wins);
    if (std::find(above.begin(), above.end(), false) == above.end()) continue;
    std::vector<std::string> beaten, others;
    for (std::size_t k = 0; k < stimuli.size(); ++k)
      (above[k] ? beaten : others).push_back(quoted(stimuli[k]));
    throw InputError(
        fmt::format("none of {} was ever preferred to any of {}, so the model has no finite "
                    "abilities; collect more comparisons, or analyse a part of the stimuli",
                    fmt::join(others, ", "), fmt::join(beaten, ", ")));
  }
}

double logistic(double x) {
  return 1.0 / (1.0 + std::exp(-x));
}

/// Sum of log-likelihoods.
double log_likelihood(const Eigen::MatrixXd& wins, const Eigen::VectorXd& ability) {
  double sum = 0.0;
  for (Index i = 0; i < wins.rows(); ++i) {
    for (Index k = 0; k < wins.cols(); ++k) {
      if (wins(i, k) > 0.0) sum -= wins(i, k) * std::log1p(std::exp(ability(k) - ability(i)));
    }
  }
  return sum;
}

/// The information of the abilities, a matrix whose rows sum to 0.
Eigen::MatrixXd information(const Eigen::MatrixXd& wins, const Eigen::VectorXd& ability) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(wins.rows(), wins.cols());
  for (Index i = 0; i < wins.rows(); ++i) {
    for (Index k = 0; k < wins.cols(); ++k) {
      if (i == k) continue;
      const double share = logistic(ability(i) - ability(k));
      const double weight = (wins(i, k) + wins(k, i)) * share * (1.0 - share);
      out(i, i) += weight;
      out(i, k) -= weight;
    }
  }
  return out;
}

/// Inverse on the vectors whose elements sum to 0, of a matrix of rank k − 1.
Eigen::MatrixXd centred_inverse(const Eigen::MatrixXd& of) {
  const auto k = static_cast<double>(of.rows());
  const Eigen::MatrixXd mean = Eigen::MatrixXd::Constant(of.rows(), of.cols(), 1.0 / k);
  return (of + mean).inverse() - mean;
}

/// Maximises the likelihood, which is concave, by Newton's steps; a step that lowers it is halved.
Eigen::VectorXd fit_abilities(const Eigen::MatrixXd& wins) {
  Eigen::VectorXd ability = Eigen::VectorXd::Zero(wins.rows());
  double best = log_likelihood(wins, ability);
  constexpr int kMostSteps = 200;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::VectorXd gradient = wins.rowwise().sum();
    for (Index i = 0; i < wins.rows(); ++i) {
      for (Index k = 0; k < wins.cols(); ++k)
        gradient(i) -= (wins(i, k) + wins(k, i)) * logistic(ability(i) - ability(k));
    }
    Eigen::VectorXd move = centred_inverse(information(wins, ability)) * gradient;
    if (move.cwiseAbs().maxCoeff() < 1e-11) break;
    double next = log_likelihood(wins, ability + move);
    while (next < best - 1e-9 * std::abs(best)) {
      move *= 0.5;
      next = log_likelihood(wins, ability + move);
    }
    ability += move;
    best = next;
  }
  return ability;
}

std::optional<TestResult> misfit_of(const Eigen::MatrixXd& wins, const Eigen::VectorXd& ability) {
  double saturated = 0.0;
  int pairs = 0;
  for (Index i = 0; i < wins.rows(); ++i) {
    for (Index k = 0; k < wins.cols(); ++k) {
      const double all = wins(i, k) + wins(k, i);
      if (wins(i, k) > 0.0) saturated += wins(i, k) * std::log(wins(i, k) / all);
      pairs += i < k && all > 0.0 ? 1 : 0;
    }
  }
  const auto df = static_cast<double>(pairs - wins.rows() + 1);
  if (df < 1.0) return std::nullopt;
  const double deviance = std::max(0.0, 2.0 * (saturated - log_likelihood(wins, ability)));
  return TestResult{deviance, df, bm::cdf(bm::complement(bm::chi_squared(df), deviance))};
}

std::vector<AbilityDifference> differences_of(const BradleyTerry& fit, const Eigen::MatrixXd& wins,
                                              const Eigen::MatrixXd& covariance, double z) {
  std::vector<AbilityDifference> out;
  std::vector<double> p;
  for (Index b = 1; b < wins.rows(); ++b) {
    for (Index a = 0; a < b; ++a) {
      const StimulusAbility& first = fit.stimuli[static_cast<std::size_t>(a)];
      const StimulusAbility& second = fit.stimuli[static_cast<std::size_t>(b)];
      AbilityDifference& of = out.emplace_back();
      of.first = first.stimulus;
      of.second = second.stimulus;
      of.comparisons = static_cast<int>(std::lround(wins(a, b) + wins(b, a)));
      of.preferred = wins(b, a);
      of.difference = second.ability - first.ability;
      of.error = std::sqrt(covariance(a, a) + covariance(b, b) - 2.0 * covariance(a, b));
      of.interval = {of.difference - z * of.error, of.difference + z * of.error};
      of.share = logistic(of.difference);
      const double off = std::abs(of.difference) / of.error;
      of.p = std::min(1.0, 2.0 * bm::cdf(bm::complement(bm::normal(), off)));
      p.push_back(of.p);
    }
  }
  const std::vector<double> corrected = holm(p);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].holm_p = corrected[i];
  return out;
}

}  // namespace

BradleyTerry fit_bradley_terry(std::span<const PairedComparison> comparisons, double level) {
  if (comparisons.empty()) throw InputError("there is no comparison");
  BradleyTerry out;
  out.level = level;
  out.comparisons = comparisons.size();
  for (const PairedComparison& x : comparisons) {
    out.ties += x.preferred == PairedComparison::Preferred::Neither ? 1 : 0;
    if (!x.participant.empty()) place_of(x.participant, out.participants);
  }
  std::vector<std::string> names;
  const Eigen::MatrixXd wins = wins_of(comparisons, names);
  require_finite(wins, names);
  const Eigen::VectorXd ability = fit_abilities(wins);
  const Eigen::MatrixXd covariance = centred_inverse(information(wins, ability));
  const double z = bm::quantile(bm::complement(bm::normal(), 0.5 * (1.0 - level)));
  for (Index i = 0; i < wins.rows(); ++i) {
    StimulusAbility& of = out.stimuli.emplace_back();
    of.stimulus = names[static_cast<std::size_t>(i)];
    of.preferred = wins.row(i).sum();
    of.comparisons = static_cast<int>(std::lround(of.preferred + wins.col(i).sum()));
    of.ability = ability(i);
    of.error = std::sqrt(covariance(i, i));
    of.interval = {of.ability - z * of.error, of.ability + z * of.error};
  }
  out.differences = differences_of(out, wins, covariance, z);
  out.misfit = misfit_of(wins, ability);
  return out;
}

std::string in_words(const BradleyTerry& fit) {
  std::vector<StimulusAbility> ranked = fit.stimuli;
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.ability > b.ability; });
  std::vector<std::string> names;
  for (const StimulusAbility& of : ranked) names.push_back(of.stimulus);
  std::string text = fmt::format("From most to least preferred: {}.", fmt::join(names, ", "));
  std::vector<std::string> sure;
  for (const AbilityDifference& of : fit.differences) {
    if (of.holm_p >= 1.0 - fit.level) continue;
    const bool second = of.difference > 0.0;
    sure.push_back(
        fmt::format("{} over {}", second ? of.second : of.first, second ? of.first : of.second));
  }
  text += sure.empty()
              ? std::string(" No preference is significant after Holm's correction.")
              : fmt::format(" Significant after Holm's correction: {}.", fmt::join(sure, ", "));
  if (fit.misfit && fit.misfit->p < 1.0 - fit.level) {
    text += fmt::format(
        " The model does not fit: preferences differ from one order of strengths (deviance {:.1f} "
        "with {:g} degrees of freedom, {}).",
        fit.misfit->statistic, fit.misfit->df, p_in_words(fit.misfit->p));
  }
  return text +
         " Intervals and tests assume independent comparisons; those of one participant are "
         "correlated, so they are too narrow if participants differ.";
}

}  // namespace prostm
