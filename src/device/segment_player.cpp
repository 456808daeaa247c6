#include "device/segment_player.hpp"

#include <algorithm>

namespace prostm {

void SegmentPlayer::reset(int foci) {
  const std::lock_guard lock(mutex_);
  foci_ = foci;
  playing_.clear();
  next_.clear();
  has_next_ = false;
  at_ = 0;
}

void SegmentPlayer::load(std::span<const FocusSample> samples) {
  // the copy and the release of old memory happen outside of the lock
  std::vector<FocusSample> copy(samples.begin(), samples.end());
  {
    const std::lock_guard lock(mutex_);
    next_.swap(copy);
    has_next_ = true;
  }
}

void SegmentPlayer::fill(std::int64_t /*first*/, std::span<FocusSample> out) noexcept {
  const std::lock_guard lock(mutex_);
  while (!out.empty()) {
    if (at_ == playing_.size()) {
      at_ = 0;
      if (has_next_) playing_.swap(next_);
      has_next_ = false;
    }
    const std::size_t n = std::min(out.size(), playing_.size() - at_);
    std::copy_n(playing_.begin() + static_cast<std::ptrdiff_t>(at_), n, out.begin());
    at_ += n;
    out = out.subspan(n);
  }
}

}  // namespace prostm
