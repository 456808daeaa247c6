#include "prostm/felt/quasi_newton.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr float kSufficient = 1e-4F;  // Armijo's share of the expected fall
constexpr float kTiny = 1e-30F;
constexpr float kLeastCurvature = 1e-6F;  // cosine of a step and its change that is remembered
constexpr float kShorter = 0.4F;  // a step that does not lower the cost is cut to this share

}  // namespace

QuasiNewton::QuasiNewton(std::size_t most_variables) {
  const auto most = static_cast<Eigen::Index>(most_variables);
  for (auto* list : {&step_, &change_}) {
    for (Vector& v : *list) v.setZero(most);
  }
  for (Vector* v : {&x_, &gradient_, &trial_, &trial_gradient_, &direction_}) v->setZero(most);
}

float QuasiNewton::evaluate(const Cost& cost, Vector& x, Vector& gradient) {
  const auto n = static_cast<std::size_t>(variables_);
  return cost({x.data(), n}, {gradient.data(), n});
}

/// The two loops over the remembered steps, oldest last in the first one.
void QuasiNewton::find_direction() {
  std::array<float, kMemory> along{};
  auto direction = head(direction_);
  direction = -head(gradient_);
  for (std::size_t i = 0; i < remembered_; ++i) {
    along[i] = head(step_[i]).dot(direction) / curvature_[i];
    direction -= along[i] * head(change_[i]);
  }
  if (remembered_ > 0) direction *= curvature_[0] / head(change_[0]).squaredNorm();
  for (std::size_t i = remembered_; i-- > 0;) {
    const float against = head(change_[i]).dot(direction) / curvature_[i];
    direction += (along[i] - against) * head(step_[i]);
  }
}

/// Puts the last step, which lies in the spare place, to the front.
void QuasiNewton::remember() {
  std::rotate(step_.begin(), step_.end() - 1, step_.end());
  std::rotate(change_.begin(), change_.end() - 1, change_.end());
  std::rotate(curvature_.begin(), curvature_.end() - 1, curvature_.end());
  remembered_ = std::min(remembered_ + 1, kMemory);
}

/// Goes along the direction, a shorter way each time until the cost falls enough. @param share of
/// the direction to begin with. @return whether it moved.
bool QuasiNewton::advance(const Cost& cost, float share, int evaluations, int& used) {
  const float slope = head(direction_).dot(head(gradient_));
  if (!(slope < 0.0F)) return false;
  for (; used < evaluations; share *= kShorter) {
    head(trial_) = head(x_) + share * head(direction_);
    const float value = evaluate(cost, trial_, trial_gradient_);
    ++used;
    if (!(value <= value_ + kSufficient * share * slope)) continue;
    auto step = head(step_.back()), change = head(change_.back());
    step = head(trial_) - head(x_);
    change = head(trial_gradient_) - head(gradient_);
    curvature_.back() = step.dot(change);
    if (curvature_.back() > kLeastCurvature * step.norm() * change.norm()) remember();
    x_.swap(trial_);
    gradient_.swap(trial_gradient_);
    value_ = value;
    return true;
  }
  return false;
}

float QuasiNewton::begin(const Cost& cost, std::span<const float> x) {
  variables_ = static_cast<Eigen::Index>(x.size());
  remembered_ = 0;
  std::copy(x.begin(), x.end(), x_.begin());
  return value_ = evaluate(cost, x_, gradient_);
}

int QuasiNewton::run(const Cost& cost, float first_step, int evaluations, std::span<float> x) {
  int used = 1;
  do {
    find_direction();
    const float share =
        remembered_ > 0 ? 1.0F : first_step / std::max(head(direction_).norm(), kTiny);
    if (!advance(cost, share, evaluations, used)) break;
  } while (used < evaluations);
  std::copy_n(x_.begin(), x.size(), x.begin());
  return used;
}

}  // namespace prostm
