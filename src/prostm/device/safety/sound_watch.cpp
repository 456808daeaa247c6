#include "prostm/device/safety/sound_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace prostm {
namespace {

constexpr std::int64_t kMargin = 2;  // samples, for the rounding of the limiter's ramp

}  // namespace

SoundWatch::SoundWatch(std::shared_ptr<const Mute> mute, double sample_rate)
    : mute_(std::move(mute)),
      mute_samples_(std::llround(std::ceil(kMuteTime * sample_rate)) + kMargin),
      silence_samples_(std::llround(std::ceil(kSilenceTime * sample_rate))) {}

void SoundWatch::look(std::int64_t first, std::span<const FocusSample> out, int foci) noexcept {
  // all these samples were made under a mute only if it was already on before them
  const bool muted = mute_ && mute_->on(), held = muted && was_muted_;
  was_muted_ = muted;
  const auto width = static_cast<std::size_t>(foci);
  std::int64_t sample = first;
  for (std::size_t at = 0; at < out.size(); at += width, ++sample) {
    muted_for_ = held ? muted_for_ + 1 : 0;
    const std::span<const FocusSample> foci_now = out.subspan(at, width);
    if (std::any_of(foci_now.begin(), foci_now.end(),
                    [](const FocusSample& focus) { return focus.intensity > 0.0F; })) {
      silent_from_ = sample + 1;
      if (!sounds_) change(true, sample);
    } else if (sounds_ &&
               (muted_for_ >= mute_samples_ || sample + 1 - silent_from_ >= silence_samples_)) {
      change(false, silent_from_);
    }
  }
}

void SoundWatch::end() noexcept {
  if (sounds_) change(false, silent_from_);
  was_muted_ = false;
  silent_from_ = muted_for_ = 0;
  stream_.fetch_add(1, std::memory_order_release);
}

void SoundWatch::change(bool on, std::int64_t sample) noexcept {
  sounds_ = on;
  if (on) sounding_ = label_.load(std::memory_order_relaxed);
  const std::int64_t stream = stream_.load(std::memory_order_relaxed);
  if (changes_.push({sample, on, stream, sounding_})) {
    made_.fetch_add(1, std::memory_order_relaxed);
  } else {
    lost_.fetch_add(1, std::memory_order_relaxed);
  }
}

void SoundWatch::pop() {
  changes_.pop();
  taken_.fetch_add(1, std::memory_order_release);
}

bool SoundWatch::is_read() const noexcept {
  return !read_by_.load(std::memory_order_relaxed) ||
         taken_.load(std::memory_order_acquire) >= made_.load(std::memory_order_relaxed);
}

}  // namespace prostm
