#include "prostm/device/autd3/detail/autd3_loops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace prostm::autd3 {
namespace {

using Clock = Session::Clock;

constexpr int kMostStored = 65'536;  // slots of a segment
constexpr float kSilent = 0.01F;     // intensity
constexpr std::chrono::milliseconds kRenewal{20}, kWait{5};

Clock::time_point from_now(double seconds) {
  return Clock::now() + std::chrono::round<Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

std::string loop_problem(std::span<const FocusSample> samples, int foci, int most_foci, int slots) {
  if (foci < 1 || foci > most_foci) {
    return fmt::format("The loop has {} focal points a sample; AUTD3 was set up for 1 to {}.", foci,
                       most_foci);
  }
  if (samples.empty() || samples.size() % static_cast<std::size_t>(foci) != 0) {
    return fmt::format(
        "The loop holds {} focal points, which is not a whole number of samples of {}; it must "
        "hold at least one sample.",
        samples.size(), foci);
  }
  const std::size_t length = samples.size() / static_cast<std::size_t>(foci),
                    most = static_cast<std::size_t>(kMostStored / slots);
  if (length > most) {
    return fmt::format(
        "The loop has {} samples; AUTD3 holds {} of {} slots: play a shorter loop, or fewer focal "
        "points.",
        length, most, slots);
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const FocusSample& s = samples[i];
    if (s.p_D.allFinite() && std::isfinite(s.intensity) && s.intensity >= 0.0F &&
        s.intensity <= 1.0F)
      continue;
    return fmt::format(
        "Sample {} of the loop has a number that is not finite or an intensity outside of 0 to 1.",
        i / static_cast<std::size_t>(foci));
  }
  return {};
}

bool is_near(const Loop& from, const Loop& to, double step) {
  if (from.length() != to.length() || from.foci != to.foci) return false;
  const auto foci = static_cast<std::size_t>(to.foci);
  for (std::size_t i = 0; i < to.samples.size(); ++i) {
    const FocusSample& before = from.samples[i];
    const FocusSample& after = to.samples[(i + foci) % to.samples.size()];
    if (std::max(before.intensity, after.intensity) <= kSilent) continue;
    if (std::min(before.intensity, after.intensity) <= kSilent) continue;
    if ((after.p_D - before.p_D).norm() > static_cast<float>(step)) return false;
  }
  return true;
}

void Loops::load(Loop loop) {
  {
    const std::lock_guard lock(mutex_);
    next_ = std::move(loop);
  }
  loaded_.notify_all();
}

void Loops::forget() {
  playing_ = {};
  const std::lock_guard lock(mutex_);
  next_.reset();
}

bool Loops::begin(double step) {
  step_ = step;
  segment_ = 0;
  if (!output_.begin(nullptr)) return false;
  if (playing_.foci == 0) return true;
  Loop again = std::move(playing_);
  playing_ = {};
  return take(std::move(again));
}

bool Loops::play(const std::stop_token& stop) {
  std::optional<Loop> next;
  {
    std::unique_lock lock(mutex_);
    loaded_.wait_for(lock, stop, kWait, [&] { return next_.has_value(); });
    next.swap(next_);
  }
  if (stop.stop_requested()) return true;
  if (next && !take(std::move(*next))) return false;
  // poll, to notice a lost link between renewals too
  return session_.poll() && keep_audible();
}

/// Writes a loop to the idle segment and switches to it. Keeps the playing loop audible until then.
bool Loops::take(Loop loop) {
  const int free = 1 - segment_, frames = output_.frames(loop.length());
  const bool near = is_near(playing_, loop, step_);
  for (int index = 0; index < frames; ++index) {
    const bool changes = index + 1 == frames;
    if (changes && !near ? !output_.mute() : !keep_audible()) return false;
    if (!output_.send(free, Transition::Immediate, loop.length(), index, loop.words) ||
        !session_.confirm()) {
      return false;
    }
  }
  segment_ = free;
  playing_ = std::move(loop);
  renewed_ = {};
  return true;
}

bool Loops::keep_audible() {
  if (playing_.foci == 0 || Clock::now() < renewed_ + kRenewal) return true;
  renewed_ = Clock::now();
  return output_.sound(renewed_, from_now(kAudibleTime));
}

}  // namespace prostm::autd3
