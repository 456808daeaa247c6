#include "prostm/felt/quasi_newton.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr float kSufficient = 1e-4F;  // Armijo's share of the expected decrease
constexpr float kTiny = 1e-30F;
constexpr float kLeastCurvature = 1e-6F;  // least cosine between a stored step and its change
constexpr float kShorter = 0.4F;          // factor on a step that does not lower the cost

}  // namespace

struct QuasiNewton::Operations {
  Eigen::Index variables;

  float dot(const Vector& a, const Vector& b) const {
    return a.head(variables).dot(b.head(variables));
  }
  void add(Vector& v, float factor, const Vector& w) const {
    v.head(variables) += factor * w.head(variables);
  }
  void scale(Vector& v, float factor) const { v.head(variables) *= factor; }
  void precondition(Vector& /*v*/) const {}
};

QuasiNewton::QuasiNewton(std::size_t most_variables)
    : memory_(Vector::Zero(static_cast<Eigen::Index>(most_variables))) {
  for (Vector* v : {&x_, &gradient_, &trial_, &trial_gradient_, &direction_})
    v->setZero(static_cast<Eigen::Index>(most_variables));
}

float QuasiNewton::evaluate(const Cost& cost, Vector& x, Vector& gradient) {
  const auto n = static_cast<std::size_t>(variables_);
  return cost({x.data(), n}, {gradient.data(), n});
}

void QuasiNewton::find_direction() {
  head(direction_) = -head(gradient_);
  memory_.find_direction(Operations{variables_}, direction_);
}

/// Backtracking line search along the direction, until the cost falls enough. @param share initial
/// step, as a share of the direction. @return whether x moved.
bool QuasiNewton::advance(const Cost& cost, float share, int evaluations, int& used) {
  const float slope = head(direction_).dot(head(gradient_));
  if (!(slope < 0.0F)) return false;
  for (; used < evaluations; share *= kShorter) {
    head(trial_) = head(x_) + share * head(direction_);
    const float value = evaluate(cost, trial_, trial_gradient_);
    ++used;
    if (!(value <= value_ + kSufficient * share * slope)) continue;
    auto step = head(memory_.step()), change = head(memory_.change());
    step = head(trial_) - head(x_);
    change = head(trial_gradient_) - head(gradient_);
    const float curvature = step.dot(change);
    if (curvature > kLeastCurvature * step.norm() * change.norm())
      memory_.keep(curvature, curvature / change.squaredNorm());
    x_.swap(trial_);
    gradient_.swap(trial_gradient_);
    value_ = value;
    return true;
  }
  return false;
}

float QuasiNewton::begin(const Cost& cost, std::span<const float> x) {
  variables_ = static_cast<Eigen::Index>(x.size());
  memory_.forget();
  std::copy(x.begin(), x.end(), x_.begin());
  return value_ = evaluate(cost, x_, gradient_);
}

int QuasiNewton::run(const Cost& cost, float first_step, int evaluations, std::span<float> x) {
  int used = 1;
  do {
    find_direction();
    const float share =
        memory_.is_empty() ? first_step / std::max(head(direction_).norm(), kTiny) : 1.0F;
    if (!advance(cost, share, evaluations, used)) break;
  } while (used < evaluations);
  std::copy_n(x_.begin(), x.size(), x.begin());
  return used;
}

}  // namespace prostm
