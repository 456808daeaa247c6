#include "playback.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace standin {
namespace {

constexpr std::int64_t kTick = 25'000;  // [ns]
constexpr double kAudible = 0.01;

double place(std::uint64_t word, int axis) {
  auto value = static_cast<std::int64_t>(word >> (18 * axis) & 0x3FFFF);
  if (value >= 0x20000) value -= 0x40000;
  return 0.025 * static_cast<double>(value);
}

}  // namespace

std::vector<Focus> foci_of(const std::uint64_t* words, std::uint32_t slots) {
  constexpr std::uint64_t kPlace = (std::uint64_t{1} << 54) - 1;
  bool pairs = slots % 2 == 0;
  for (std::uint32_t s = 0; pairs && s < slots; s += 2)
    pairs = (words[s] & kPlace) == (words[s + 1] & kPlace);
  const double intensity = static_cast<double>(words[0] >> 54 & 0xFF) / 255.0;
  const std::uint32_t step = pairs ? 2 : 1;
  std::vector<Focus> foci;
  for (std::uint32_t s = 0; s < slots; s += step) {
    std::complex<double> sum = 0.0;
    for (std::uint32_t i = s; i < s + step; ++i) {
      const double turns = i == 0 ? 0.0 : static_cast<double>(words[i] >> 54 & 0xFF) / 256.0;
      sum += std::polar(1.0 / step, 2.0 * std::numbers::pi * turns);
    }
    foci.push_back(
        {place(words[s], 0), place(words[s], 1), place(words[s], 2), intensity * std::abs(sum)});
  }
  return foci;
}

void Playback::clear() {
  for (Bank& bank : banks) {
    bank.raw = true;
    bank.divider = bank.repetitions = 0xFFFF;
    bank.samples = 2;
    std::fill(bank.words.begin(), bank.words.end(), 0);
  }
  bank_ = 0;
  pending_ = -1;
  stopped_ = finite_ = alternates_ = sounds_ = false;
  last_.clear();
}

void Playback::activate(int bank, int mode) {
  if (banks[static_cast<std::size_t>(bank)].repetitions == 0xFFFF) {
    bank_ = bank;
    pending_ = -1;
    stopped_ = finite_ = false;
    alternates_ = mode == 0xF0;
  } else if (bank != (pending_ >= 0 ? pending_ : bank_)) {
    pending_ = bank;
  }
}

std::int64_t Playback::index(int bank, std::int64_t tick) const {
  const Bank& b = banks[static_cast<std::size_t>(bank)];
  return tick / b.divider % b.samples;
}

void Playback::advance(std::int64_t time) {
  const std::int64_t last = time / kTick;
  // longer ago than any duration
  tick_ = std::max(tick_, last - 400'000);
  while (tick_ < last) {
    // nothing changes between the starts of samples
    const std::int64_t next = std::min(last, next_begin());
    if (sounds_ && !muted && next > tick_ + 1) last_sounding = (next - 1) * kTick;
    tick_ = next;
    change_over(tick_);
    play(tick_);
  }
}

/// The next tick at which a sample starts, in a bank that plays or may play.
std::int64_t Playback::next_begin() const {
  std::int64_t next = INT64_MAX;
  for (const Bank& bank : banks) next = std::min(next, (tick_ / bank.divider + 1) * bank.divider);
  return next;
}

/// Follows the states of the logic: waiting, a finite loop, an infinite loop.
void Playback::change_over(std::int64_t tick) {
  const auto begins = [&](int bank) {
    return index(bank, tick) == 0 && index(bank, tick - 1) != 0;
  };
  if (pending_ >= 0) {
    if (!begins(pending_)) return;
    bank_ = pending_;
    pending_ = -1;
    stopped_ = alternates_ = false;
    finite_ = true;
    loops_ = 0;
    ++turns;
  } else if (finite_) {
    if (!begins(bank_) || stopped_) return;
    stopped_ = loops_++ == banks[static_cast<std::size_t>(bank_)].repetitions;
    stops += stopped_ ? 1 : 0;
  } else if (alternates_ && begins(bank_)) {
    bank_ = 1 - bank_;
  }
}

/// Records the sample that plays.
void Playback::play(std::int64_t tick) {
  const Bank& b = banks[static_cast<std::size_t>(bank_)];
  if (b.raw) {
    sounds_ = false;
    return last_.clear();
  }
  const std::int64_t i = stopped_ ? b.samples - 1 : index(bank_, tick);
  const std::uint64_t* words = b.words.data() + i * b.slots;
  const bool is_new = i != last_index_ || bank_ != last_bank_;
  if (is_new) {
    const std::vector<Focus> foci = foci_of(words, b.slots);
    const std::size_t count = muted ? 0 : std::min(foci.size(), last_.size());
    for (std::size_t f = 0; f < count; ++f) {
      if (foci[f].amplitude <= kAudible || last_[f].amplitude <= kAudible) continue;
      const double step =
          std::hypot(foci[f].x - last_[f].x, foci[f].y - last_[f].y, foci[f].z - last_[f].z);
      largest_step = std::max(largest_step, step);
      largest_speed = std::max(largest_speed, step / (0.025 * b.divider));
    }
    last_ = foci;
    last_index_ = i;
    last_bank_ = bank_;
    if (records) {
      Played p{tick, b.slots, muted ? 1U : 0U, {}};
      std::copy_n(words, b.slots, p.words.begin());
      played.push_back(p);
    }
  }
  const auto sounds = [](const Focus& focus) { return focus.amplitude > kAudible; };
  sounds_ = std::any_of(last_.begin(), last_.end(), sounds);
  if (!muted && sounds_) last_sounding = tick * kTick;
}

}  // namespace standin
