#include "prostm/device/detail/segment_player.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace prostm {

std::string segment_problem(std::span<const FocusSample> samples, int foci, int max_foci) {
  std::ostringstream text;
  if (foci < 1 || foci > max_foci) {
    text << "The segment has " << foci << " focal points a sample; the array plays 1 to "
         << max_foci << ".";
  } else if (samples.empty() || samples.size() % static_cast<std::size_t>(foci) != 0) {
    text << "The segment holds " << samples.size()
         << " focal points, which is not a whole number of "
         << "samples of " << foci << "; it must hold at least one sample.";
  } else {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const FocusSample& s = samples[i];
      if (s.p_D.allFinite() && std::isfinite(s.intensity) && s.intensity >= 0.0F &&
          s.intensity <= 1.0F) {
        continue;
      }
      text << "Sample " << i / static_cast<std::size_t>(foci)
           << " of the segment has a number that is not finite or an intensity outside of 0 to 1.";
      break;
    }
  }
  return text.str();
}

void SegmentPlayer::reset(int foci) {
  const std::lock_guard lock(mutex_);
  foci_ = foci;
  playing_.clear();
  next_.clear();
  has_next_ = false;
  at_ = 0;
  loads_ = 0;
  now_ = {};
}

void SegmentPlayer::load(std::span<const FocusSample> samples) {
  // copy, and release old memory, outside the lock
  std::vector<FocusSample> copy(samples.begin(), samples.end());
  {
    const std::lock_guard lock(mutex_);
    next_.swap(copy);
    has_next_ = true;
    ++loads_;
  }
}

SegmentPlayer::Playing SegmentPlayer::playing() const {
  const std::lock_guard lock(mutex_);
  return now_;
}

/// Switches to the newest loaded segment, unless it plays already, from sample `first` on. Never
/// blocks: while another segment is being loaded, the current segment repeats.
void SegmentPlayer::take_next(std::int64_t first) noexcept {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock || !has_next_) return;
  playing_.swap(next_);
  has_next_ = false;
  now_ = {loads_, first};
}

void SegmentPlayer::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  const std::int64_t end = first + static_cast<std::int64_t>(out.size()) / foci_;
  while (!out.empty()) {
    if (at_ == playing_.size()) {
      at_ = 0;
      take_next(end - static_cast<std::int64_t>(out.size()) / foci_);
    }
    if (playing_.empty()) {
      std::fill(out.begin(), out.end(), FocusSample());
      return;
    }
    const std::size_t n = std::min(out.size(), playing_.size() - at_);
    std::copy_n(playing_.begin() + static_cast<std::ptrdiff_t>(at_), n, out.begin());
    at_ += n;
    out = out.subspan(n);
  }
}

}  // namespace prostm
