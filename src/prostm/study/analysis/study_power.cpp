#include "prostm/study/analysis/study_power.hpp"

#include <algorithm>
#include <array>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

namespace bm = boost::math;

constexpr double kMostScore = 6.0;  // largest normal score of the table of shares
constexpr int kPerScore = 100;      // values of the table in one unit of score

/// The share of a person at each normal score, from −kMostScore.
std::vector<double> share_quantiles(double mean, double correlation) {
  const double sum = (1.0 - correlation) / correlation;
  const bm::beta_distribution<> shares(sum * mean, sum * (1.0 - mean));
  std::vector<double> out;
  const int ends = static_cast<int>(kMostScore) * kPerScore;
  for (int i = -ends; i <= ends; ++i) {
    const double below = bm::cdf(bm::normal(), static_cast<double>(i) / kPerScore);
    out.push_back(bm::quantile(shares, below));
  }
  return out;
}

double share_at(const std::vector<double>& quantiles, double score) {
  const double at = (std::clamp(score, -kMostScore, kMostScore) + kMostScore) * kPerScore;
  const auto low = std::min(static_cast<std::size_t>(at), quantiles.size() - 2);
  const double part = at - static_cast<double>(low);
  return (1.0 - part) * quantiles[low] + part * quantiles[low + 1];
}

/// Mean and sum of squared deviations of values that come one by one (Welford).
struct Moments {
  double mean = 0.0, squares = 0.0;
  int n = 0;

  void add(double x) {
    const double off = x - mean;
    mean += off / ++n;
    squares += off * (x - mean);
  }
  double variance_of_mean() const { return squares / (n - 1.0) / n; }
};

/// Whether |t| is significant; nothing is if values do not vary.
class Significance {
 public:
  /// @param n participants, per group or in total. The degrees of freedom of Welch's test are
  /// between those of one group and of both.
  Significance(Groups groups, int n, double alpha)
      : groups_(groups), alpha_(alpha), most_(bound(n - 1.0)), least_(bound(2.0 * n - 2.0)) {}

  bool of_pairs(const Moments& change) const {
    const double variance = change.variance_of_mean();
    return variance > kRounding && std::abs(change.mean) > most_ * std::sqrt(variance);
  }
  bool of_groups(const Moments& a, const Moments& b) const {
    const double of_a = a.variance_of_mean(), of_b = b.variance_of_mean(), sum = of_a + of_b;
    if (sum <= kRounding) return false;
    const double t = std::abs(b.mean - a.mean) / std::sqrt(sum);
    if (t <= least_ || t > most_) return t > most_;
    return t > bound(sum * sum * (a.n - 1.0) / (of_a * of_a + of_b * of_b));
  }
  bool of(const std::array<Moments, 2>& x) const {
    return groups_ == Groups::Within ? of_pairs(x[0]) : of_groups(x[0], x[1]);
  }

 private:
  static constexpr double kRounding = 1e-24;
  double bound(double df) const {
    return bm::quantile(bm::complement(bm::students_t(df), 0.5 * alpha_));
  }

  Groups groups_;
  double alpha_, most_, least_;
};

}  // namespace

void validate(const StudyDesign& design) {
  require_between("alpha", design.alpha, 0.0001, 0.5);
  if (design.d) return require_between("d", *design.d, 0.01, 10.0);
  require_between("the first share", design.shares.first, 0.01, 0.99);
  require_between("the second share", design.shares.second, 0.01, 0.99);
  require_between("trials", design.shares.trials, 1, 1000);
  require_between("correlation", design.shares.correlation, 0.001, 0.9);
  require_between("alike", design.shares.alike, 0.0, 0.99);
}

/// One study, to which participants are added.
class SimulatedStudies::Study {
 public:
  explicit Study(std::uint64_t seed) : random_(seed) {}

  /// Adds a participant; between participants, one with each method.
  void add_participant(const StudyDesign& design, const std::vector<double> (&quantiles)[2]) {
    const bool within = design.groups == Groups::Within;
    double a = 0.0, b = 0.0;
    if (design.d) {
      a = within ? 0.0 : random_.normal();
      b = *design.d + random_.normal();
    } else {
      const double alike = within ? design.shares.alike : 0.0;
      const double common = std::sqrt(alike) * random_.normal(), own = std::sqrt(1.0 - alike);
      a = score(share_at(quantiles[0], common + own * random_.normal()), design.shares.trials);
      b = score(share_at(quantiles[1], common + own * random_.normal()), design.shares.trials);
    }
    if (within) return moments_[0].add(b - a);
    moments_[0].add(a);
    moments_[1].add(b);
  }
  const std::array<Moments, 2>& moments() const { return moments_; }

 private:
  double score(double share, int trials) {
    int right = 0;
    for (int i = 0; i < trials; ++i) right += random_.uniform() < share ? 1 : 0;
    return static_cast<double>(right) / trials;
  }

  Random random_;
  std::array<Moments, 2> moments_;  // of differences, or of both groups
};

SimulatedStudies::SimulatedStudies(const StudyDesign& design, int studies, std::uint64_t seed)
    : design_(design) {
  if (!design.d) {
    quantiles_[0] = share_quantiles(design.shares.first, design.shares.correlation);
    quantiles_[1] = share_quantiles(design.shares.second, design.shares.correlation);
  }
  Random seeds(seed);
  studies_.reserve(static_cast<std::size_t>(studies));
  for (int i = 0; i < studies; ++i) studies_.emplace_back(seeds.bits());
  for (Study& study : studies_) study.add_participant(design_, quantiles_);
  significant_ = {0, 0};  // a test needs two participants
}

SimulatedStudies::~SimulatedStudies() = default;

void SimulatedStudies::reach(int n) {
  while (static_cast<int>(significant_.size()) <= n) {
    const Significance test(design_.groups, static_cast<int>(significant_.size()), design_.alpha);
    int count = 0;
    for (Study& study : studies_) {
      study.add_participant(design_, quantiles_);
      count += test.of(study.moments()) ? 1 : 0;
    }
    significant_.push_back(count);
  }
}

Proportion SimulatedStudies::power(int n) {
  reach(n);
  return {significant_[static_cast<std::size_t>(n)], static_cast<int>(studies_.size())};
}

std::optional<int> SimulatedStudies::needed(double power, int most) {
  // power may fall by chance after it was reached, so half as many participants again are simulated
  int enough = 2;
  for (int n = 2; n <= most && n <= enough + enough / 2; ++n) {
    if (this->power(n).value() < power) enough = n + 1;
  }
  if (enough > most) return std::nullopt;
  return enough;
}

}  // namespace prostm
