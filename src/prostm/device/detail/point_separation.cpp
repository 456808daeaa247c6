#include "prostm/device/detail/point_separation.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

// A point that sounds counts as this much stronger, so that equals do not take turns.
constexpr float kStays = 1.5F;

bool is_finite(const FocusSample& s) {
  return std::isfinite(s.p_D.x()) && std::isfinite(s.p_D.y()) && std::isfinite(s.p_D.z()) &&
         std::isfinite(s.intensity);
}

}  // namespace

void PointSeparation::configure(int foci, double least, int fade) {
  foci_ = static_cast<std::size_t>(foci);
  // one point has no neighbour
  const bool apart = foci > 1 && least > 0.0;
  delay_ = apart ? fade : 0;
  step_ = 1.0F / static_cast<float>(fade);
  const auto smallest = static_cast<float>(apart ? least : 0.0);
  least_squared_ = smallest * smallest;
  line_.assign((static_cast<std::size_t>(delay_) + 1) * foci_, Waiting{});
  sounds_.assign(foci_, 0);
  refused_.assign(foci_, 0);
  order_.assign(foci_, 0);
  newest_ = 0;
  weakened_ = 0;
}

/// Returns the sample of a focal point that came `back` samples before the newest.
PointSeparation::Waiting& PointSeparation::waiting(std::size_t focus, std::size_t back) {
  const std::size_t length = static_cast<std::size_t>(delay_) + 1;
  return line_[(newest_ + length - back) % length * foci_ + focus];
}

/// Chooses the points of the newest sample that must be silent: `refused_`.
void PointSeparation::choose() {
  const auto strength = [this](std::size_t f) {
    return waiting(f, 0).sample.intensity * (sounds_[f] != 0 ? kStays : 1.0F);
  };
  // insertion keeps the order of equals, and needs no memory
  for (std::size_t f = 0; f < foci_; ++f) {
    std::size_t at = f;
    for (; at > 0 && strength(order_[at - 1]) < strength(f); --at) order_[at] = order_[at - 1];
    order_[at] = f;
  }
  for (std::size_t k = 0; k < foci_; ++k) {
    const FocusSample& sample = waiting(order_[k], 0).sample;
    bool close = false;
    for (std::size_t other = 0; other < k && sample.intensity > 0.0F; ++other) {
      const FocusSample& stronger = waiting(order_[other], 0).sample;
      close = close || (refused_[order_[other]] == 0 && stronger.intensity > 0.0F &&
                        (stronger.p_D - sample.p_D).squaredNorm() < least_squared_);
    }
    refused_[order_[k]] = close ? 1 : 0;
  }
}

/// Sets the gain of a point's newest sample, and of those before it that must fade.
void PointSeparation::gate(std::size_t focus, bool silenced) {
  Waiting& now = waiting(focus, 0);
  if (!silenced) {
    now.gain = delay_ > 0 ? std::min(1.0F, waiting(focus, 1).gain + step_) : 1.0F;
    return;
  }
  now.gain = 0.0F;
  for (std::size_t back = 1; back <= static_cast<std::size_t>(delay_); ++back) {
    float& gain = waiting(focus, back).gain;
    const float most = static_cast<float>(back) * step_;
    if (gain <= most) break;
    gain = most;
  }
}

void PointSeparation::step(std::span<const FocusSample> in, std::span<FocusSample> out) noexcept {
  newest_ = (newest_ + 1) % (static_cast<std::size_t>(delay_) + 1);
  for (std::size_t f = 0; f < foci_; ++f) {
    FocusSample& sample = waiting(f, 0).sample;
    if (is_finite(in[f])) {
      sample = {in[f].p_D, std::clamp(in[f].intensity, 0.0F, 1.0F)};
    } else {
      const Eigen::Vector3f before =
          delay_ > 0 ? waiting(f, 1).sample.p_D : Eigen::Vector3f(sample.p_D);
      sample = {before, 0.0F};
    }
  }
  if (delay_ > 0) choose();
  for (std::size_t f = 0; f < foci_; ++f) {
    const bool silenced = refused_[f] != 0 || !is_finite(in[f]);
    gate(f, silenced);
    sounds_[f] = !silenced && waiting(f, 0).sample.intensity > 0.0F ? 1 : 0;
  }
  for (std::size_t f = 0; f < foci_; ++f) {
    const Waiting& oldest = waiting(f, static_cast<std::size_t>(delay_));
    weakened_ += oldest.gain < 1.0F && oldest.sample.intensity > 0.0F ? 1 : 0;
    out[f] = {oldest.sample.p_D, oldest.sample.intensity * oldest.gain};
  }
}

}  // namespace prostm
