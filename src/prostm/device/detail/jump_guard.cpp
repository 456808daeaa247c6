#include "prostm/device/detail/jump_guard.hpp"

#include <algorithm>

namespace prostm {
namespace {

constexpr float kFastest = 6.0F;  // of a path, in the longest step that never counts as a jump

}  // namespace

void JumpGuard::reset(int foci, double longest) {
  last_.assign(static_cast<std::size_t>(foci), Last());
  longest_ = static_cast<float>(longest);
}

void JumpGuard::apply(std::span<FocusSample> sample) noexcept {
  for (std::size_t f = 0; f < std::min(sample.size(), last_.size()); ++f) {
    Last& last = last_[f];
    const float step = (sample[f].p_D - last.p_D).norm();
    // tested so that a step that is not a number counts as a jump
    const bool moves = last.known && step <= std::max(longest_, 2.0F * last.step);
    if (!moves) sample[f].intensity = 0.0F;
    last = {sample[f].p_D, last.known && step <= kFastest * longest_ ? step : 0.0F, true};
  }
}

}  // namespace prostm
