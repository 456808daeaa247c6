#include "prostm/device/ultraleap/detail/play_log.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

}  // namespace

void PlayLog::reset(double rate) {
  calls_.store(0, std::memory_order_release);
  rate_ = rate;
}

void PlayLog::add(const Call& call) noexcept {
  const std::int64_t at = calls_.load(kRelaxed);
  Slot& slot = slots_[static_cast<std::size_t>(at) % kCalls];
  slot.first.store(call.first, kRelaxed);
  slot.samples.store(call.samples, kRelaxed);
  slot.play_time.store(call.play_time, kRelaxed);
  slot.pulled.store(call.pulled, kRelaxed);
  slot.time.store(call.time, kRelaxed);
  calls_.store(at + 1, std::memory_order_release);
}

/// Reads a call; false if it was overwritten during the read.
bool PlayLog::read(std::int64_t call, Call& out) const {
  const Slot& slot = slots_[static_cast<std::size_t>(call) % kCalls];
  // acquire, so that the count below is read after the members
  constexpr auto kAcquire = std::memory_order_acquire;
  out = {slot.first.load(kAcquire), slot.samples.load(kAcquire), slot.play_time.load(kAcquire),
         slot.pulled.load(kAcquire), slot.time.load(kAcquire)};
  return calls_.load(kAcquire) < call + static_cast<std::int64_t>(kCalls);
}

/// Finds the newest call for which `is_it` holds, else the oldest call; false if the log is empty.
template <class Is>
bool PlayLog::find(Is&& is_it, Call& out) const {
  const std::int64_t calls = this->calls();
  const auto kept = static_cast<std::int64_t>(kCalls) - 1;
  bool found = false;
  Call call;
  for (std::int64_t at = calls - 1; at >= std::max<std::int64_t>(0, calls - kept); --at) {
    if (!read(at, call)) break;
    out = call;
    found = true;
    if (is_it(call)) break;
  }
  return found;
}

double PlayLog::play_time(std::int64_t sample) const {
  Call call;
  if (!find([&](const Call& c) { return c.first <= sample; }, call)) return 0.0;
  return call.play_time + static_cast<double>(sample - call.first) / rate_;
}

double PlayLog::ask_time(std::int64_t sample) const {
  Call call;
  if (!find([&](const Call& c) { return c.pulled <= sample; }, call)) return 0.0;
  // a sample that was not pulled yet, or long ago: extrapolate by the sample rate
  const std::int64_t later = sample - call.pulled;
  const bool is_newest = call.pulled == newest().pulled;
  const bool inside = later >= 0 && (!is_newest || later < std::max<std::int64_t>(1, call.samples));
  return call.time + (inside ? 0.0 : static_cast<double>(later) / rate_);
}

std::int64_t PlayLog::played(double now) const {
  Call call;
  if (!find([&](const Call& c) { return c.play_time <= now; }, call)) return 0;
  if (call.play_time > now) return call.first;
  const double since = std::floor((now - call.play_time) * rate_) + 1.0;
  return call.first + static_cast<std::int64_t>(std::min(since, static_cast<double>(call.samples)));
}

PlayLog::Call PlayLog::newest() const {
  Call call;
  find([](const Call&) { return true; }, call);
  return call;
}

}  // namespace prostm
