#include "prostm/device/detail/jump_guard.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr float kFarthest = 100.0F;  // [m], beyond which there are no focal points
constexpr float kFastest = 6.0F;     // of a path, in the longest step that never counts as a jump

/// Tested so that NaN is not compared.
bool is_place(const Eigen::Vector3f& p) {
  for (const float x : p)
    if (!std::isfinite(x) || std::abs(x) > kFarthest) return false;
  return true;
}

}  // namespace

void JumpGuard::reset(int foci, double longest) {
  last_.assign(static_cast<std::size_t>(foci), Last());
  longest_ = static_cast<float>(longest);
}

void JumpGuard::apply(std::span<FocusSample> sample) noexcept {
  for (std::size_t f = 0; f < std::min(sample.size(), last_.size()); ++f) {
    Last& last = last_[f];
    if (!is_place(sample[f].p_D)) {
      sample[f].intensity = 0.0F;
      last.known = false;
      continue;
    }
    const float step = last.known ? (sample[f].p_D - last.p_D).norm() : 0.0F;
    const bool moves = last.known && step <= std::max(longest_, 2.0F * last.step);
    if (!moves) sample[f].intensity = 0.0F;
    last = {sample[f].p_D, step <= kFastest * longest_ ? step : 0.0F, true};
  }
}

}  // namespace prostm
