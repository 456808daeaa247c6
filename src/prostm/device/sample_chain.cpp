#include "prostm/device/sample_chain.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr std::size_t kAtOnce = 64;  // samples of a decimated stream that are made at a time
constexpr double kRounding = 1e-4;   // rounding of floats, which is no excess

/// Whether all numbers are finite, without comparisons, which trap on NaN.
bool is_finite(const FocusSample& s) {
  return std::isfinite(s.p_D.x()) && std::isfinite(s.p_D.y()) && std::isfinite(s.p_D.z()) &&
         std::isfinite(s.intensity);
}

}  // namespace

void SharedIntensity::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  from().fill(first, out);
  const auto width = static_cast<std::size_t>(foci());
  for (std::size_t at = 0; at < out.size(); at += width) {
    const std::span<FocusSample> sample = out.subspan(at, width);
    float largest = 0.0F;
    for (const FocusSample& focus : sample) largest = std::max(largest, focus.intensity);
    for (FocusSample& focus : sample) focus.intensity = largest;
  }
}

void Decimation::follow(SampleSource& from) {
  SampleStage::follow(from);
  scratch_.resize(kAtOnce * static_cast<std::size_t>(factor_ * from.foci()));
}

void Decimation::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  const auto width = static_cast<std::size_t>(foci()), factor = static_cast<std::size_t>(factor_);
  const std::size_t samples = out.size() / width;
  for (std::size_t begin = 0; begin < samples; begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, samples - begin);
    from().fill((first + static_cast<std::int64_t>(begin)) * factor_,
                std::span(scratch_).first(count * factor * width));
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(scratch_.begin() + static_cast<std::ptrdiff_t>(i * factor * width), width,
                  out.begin() + static_cast<std::ptrdiff_t>((begin + i) * width));
    }
  }
}

void SampleTap::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  from().fill(first, out);
  for (const FocusSample& focus : out) {
    if (!ring_.push(focus)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

void SampleLimiter::follow(SampleSource& from) {
  SampleStage::follow(from);
  last_.assign(static_cast<std::size_t>(from.foci()), FocusSample());
}

void SampleLimiter::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  from().fill(first, out);
  const auto change = static_cast<float>(limits_.change * (1.0 + kRounding));
  std::int64_t limited = 0;
  for (std::size_t at = 0; at < out.size(); at += last_.size()) {
    double power = 0.0;
    for (std::size_t f = 0; f < last_.size(); ++f) {
      FocusSample& now = out[at + f];
      FocusSample& last = last_[f];
      const FocusSample given = now;
      if (!is_finite(now)) now = {last.p_D, 0.0F};
      now.intensity = std::clamp(std::clamp(now.intensity, 0.0F, 1.0F), last.intensity - change,
                                 last.intensity + change);
      power += static_cast<double>(now.intensity) * static_cast<double>(now.intensity);
      limited += !is_finite(given) || now.intensity != given.intensity ? 1 : 0;
      last = now;
    }
    if (power <= limits_.power * (1.0 + kRounding)) continue;
    const auto share = static_cast<float>(std::sqrt(limits_.power / power));
    for (std::size_t f = 0; f < last_.size(); ++f) {
      out[at + f].intensity *= share;
      last_[f].intensity = out[at + f].intensity;
      ++limited;
    }
  }
  if (limited > 0) limited_.fetch_add(limited, std::memory_order_relaxed);
}

SampleChain::SampleChain(SampleSource& source, const SampleLimits& limits)
    : source_(source), limiter_(limits) {
  static_cast<SampleStage&>(limiter_).follow(source);
}

void SampleChain::append(std::unique_ptr<SampleStage> stage) {
  stage->follow(stages_.empty() ? source_ : *stages_.back());
  static_cast<SampleStage&>(limiter_).follow(*stage);
  stages_.push_back(std::move(stage));
}

std::unique_ptr<SampleChain> make_sample_chain(SampleSource& source, const DeviceInfo& device,
                                               const SampleLimits& limits) {
  // decimated samples may change more, so that the change in time stays the same
  auto chain = std::make_unique<SampleChain>(
      source, SampleLimits{limits.power, limits.change * device.decimation});
  if (device.decimation > 1) chain->add<Decimation>(device.decimation);
  if (!device.intensity_per_focus) chain->add<SharedIntensity>();
  return chain;
}

}  // namespace prostm
