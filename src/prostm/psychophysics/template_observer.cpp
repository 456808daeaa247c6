#include "prostm/psychophysics/template_observer.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "prostm/core/require.hpp"

namespace prostm {
namespace {

double dot(const Percept& a, const Percept& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void require_template(const Percept& percept) {
  if (percept.empty() || !std::ranges::all_of(percept, [](double v) { return std::isfinite(v); }))
    throw std::invalid_argument("a template must not be empty, and all its numbers must be finite");
}

}  // namespace

TemplateObserver::TemplateObserver(const Percept& first, const Percept& second,
                                   const ObserverNoise& noise) {
  require_template(first);
  require_template(second);
  if (first.size() != second.size())
    throw std::invalid_argument("the two templates must have the same size");
  require_between("local noise", noise.local, 1e-6, 1e6);
  require_between("common noise", noise.common, 0.0, 1e6);
  middle_.resize(first.size());
  weight_.resize(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    middle_[i] = 0.5 * (first[i] + second[i]);
    weight_[i] = second[i] - first[i];
  }
  double largest = 0.0;
  for (const double v : middle_) largest = std::max(largest, std::abs(v));
  if (largest == 0.0) return;
  // the inverse of (Y3)'s covariance, by the Sherman-Morrison formula
  const double variance = noise.local * largest * noise.local * largest;
  const double common = noise.common * noise.common;
  const double along = common * dot(middle_, weight_) / (variance + common * dot(middle_, middle_));
  Percept inverse = weight_;
  for (std::size_t i = 0; i < inverse.size(); ++i)
    inverse[i] = (weight_[i] - along * middle_[i]) / variance;
  d_prime_ = std::sqrt(std::max(0.0, dot(weight_, inverse)));
  weight_ = std::move(inverse);
}

double TemplateObserver::evidence(const Percept& percept) const {
  if (d_prime_ == 0.0) return 0.0;
  return (dot(weight_, percept) - dot(weight_, middle_)) / d_prime_;
}

double chance_of_right(double evidence, double lapse) {
  return 0.5 * lapse + (1.0 - lapse) * boost::math::cdf(boost::math::normal(), evidence);
}

}  // namespace prostm
