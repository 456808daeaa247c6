#include "prostm/device/safety/sample_chain.hpp"

#include <algorithm>

namespace prostm {
namespace {

constexpr std::size_t kAtOnce = 64;  // decimated samples computed at a time

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
    for (std::size_t i = 0; i < count; ++i)
      std::copy_n(&scratch_[i * factor * width], width, &out[(begin + i) * width]);
  }
}

void SampleTap::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  from().fill(first, out);
  for (const FocusSample& focus : out) {
    if (!ring_.push(focus)) lost_.fetch_add(1, std::memory_order_relaxed);
  }
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
  SampleLimits own = limits;
  own.change *= device.decimation;
  own.sample_rate =
      device.sample_rate > 0.0 ? device.sample_rate : limits.sample_rate / device.decimation;
  own.one_intensity = !device.intensity_per_focus;
  auto chain = std::make_unique<SampleChain>(source, own);
  if (device.decimation > 1) chain->add<Decimation>(device.decimation);
  if (!device.intensity_per_focus) chain->add<SharedIntensity>();
  return chain;
}

}  // namespace prostm
