#include "prostm/device/safety/detail/point_gate.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

// Hysteresis: an active point counts as this much stronger, so that equals do not take turns.
constexpr float kStays = 1.5F;

bool is_finite(const FocusSample& s) {
  return std::isfinite(s.p_D.x()) && std::isfinite(s.p_D.y()) && std::isfinite(s.p_D.z()) &&
         std::isfinite(s.intensity);
}

float squared(double x) {
  return static_cast<float>(x * x);
}

}  // namespace

void PointGate::configure(int foci, const Bounds& bounds) {
  foci_ = static_cast<std::size_t>(foci);
  delay_ = std::max(1, bounds.fade);
  fade_step_ = 1.0F / static_cast<float>(delay_);
  least_squared_ = squared(std::max(0.0, bounds.least_separation));
  line_.assign((static_cast<std::size_t>(delay_) + 1) * foci_, Waiting{});
  sounds_.assign(foci_, 0);
  refused_.assign(foci_, 0);
  order_.assign(foci_, 0);
  newest_ = 0;
  weakened_ = 0;
}

/// Returns the sample of a focal point that came `back` samples before the newest.
PointGate::Waiting& PointGate::waiting(std::size_t focus, std::size_t back) {
  const std::size_t length = static_cast<std::size_t>(delay_) + 1;
  return line_[(newest_ + length - back) % length * foci_ + focus];
}

/// Adds a point's newest sample to the line; marks it in `refused_` if it is not finite.
void PointGate::take(std::size_t focus, const FocusSample& given) {
  const FocusSample& before = waiting(focus, 1).sample;
  FocusSample& now = waiting(focus, 0).sample;
  if (!is_finite(given)) {
    now = {before.p_D, 0.0F};
    refused_[focus] = 1;
    return;
  }
  now = {given.p_D, std::clamp(given.intensity, 0.0F, 1.0F)};
  refused_[focus] = 0;
}

/// Marks the points of the newest sample that are too close to a stronger one.
void PointGate::choose() {
  const auto strength = [this](std::size_t f) {
    if (refused_[f] != 0) return 0.0F;
    return waiting(f, 0).sample.intensity * (sounds_[f] != 0 ? kStays : 1.0F);
  };
  // insertion sort keeps the order of equals and needs no memory
  for (std::size_t f = 0; f < foci_; ++f) {
    std::size_t at = f;
    for (; at > 0 && strength(order_[at - 1]) < strength(f); --at) order_[at] = order_[at - 1];
    order_[at] = f;
  }
  for (std::size_t k = 1; k < foci_; ++k) {
    const FocusSample& sample = waiting(order_[k], 0).sample;
    bool close = false;
    for (std::size_t other = 0; other < k && sample.intensity > 0.0F; ++other) {
      const FocusSample& stronger = waiting(order_[other], 0).sample;
      close = close || (refused_[order_[other]] == 0 && stronger.intensity > 0.0F &&
                        (stronger.p_D - sample.p_D).squaredNorm() < least_squared_);
    }
    if (close) refused_[order_[k]] = 1;
  }
}

/// Sets the gain of a point's newest sample, and of those before it that must fade.
void PointGate::gate(std::size_t focus) {
  Waiting& now = waiting(focus, 0);
  if (refused_[focus] == 0) {
    now.gain = std::min(1.0F, waiting(focus, 1).gain + fade_step_);
    return;
  }
  now.gain = 0.0F;
  for (std::size_t back = 1; back <= static_cast<std::size_t>(delay_); ++back) {
    float& gain = waiting(focus, back).gain;
    const float most = static_cast<float>(back) * fade_step_;
    if (gain <= most) break;
    gain = most;
  }
}

void PointGate::step(std::span<const FocusSample> in, std::span<FocusSample> out) noexcept {
  newest_ = (newest_ + 1) % (static_cast<std::size_t>(delay_) + 1);
  for (std::size_t f = 0; f < foci_; ++f) take(f, in[f]);
  choose();
  for (std::size_t f = 0; f < foci_; ++f) {
    gate(f);
    sounds_[f] = refused_[f] == 0 && waiting(f, 0).sample.intensity > 0.0F ? 1 : 0;
    const Waiting& oldest = waiting(f, static_cast<std::size_t>(delay_));
    weakened_ += oldest.gain < 1.0F && oldest.sample.intensity > 0.0F ? 1 : 0;
    out[f] = {oldest.sample.p_D, oldest.sample.intensity * oldest.gain};
  }
}

}  // namespace prostm
