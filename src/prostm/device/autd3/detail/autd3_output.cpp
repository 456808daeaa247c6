#include "prostm/device/autd3/detail/autd3_output.hpp"

#include <algorithm>
#include <array>
#include <thread>

#include "prostm/device/autd3/detail/autd3_timing.hpp"

namespace prostm::autd3 {
namespace {

using Seconds = std::chrono::duration<double>;

Session::Clock::duration to_duration(double seconds) {
  return std::chrono::round<Session::Clock::duration>(Seconds(seconds));
}

}  // namespace

void Output::configure(int slots, int divider, int samples, double sound_speed) {
  shape_.slots = slots;
  shape_.divider = divider;
  shape_.sound_speed = sound_speed;
  modulation_divider_ = std::max(kLeastModulationDivider, divider);
  const auto size = static_cast<std::size_t>(slots * samples);
  words_.resize(session_.units());
  for (std::vector<SlotWord>& unit : words_) unit.assign(size, SlotWord{0});
}

double Output::modulation_sample() const {
  return modulation_divider_ / kCarrier;
}

double Output::longest() const {
  return (kMostModulation - 1) * modulation_sample();
}

bool Output::send(int segment, Transition transition, int samples, int index,
                  const std::vector<std::vector<SlotWord>>& words) {
  FociSegment shape = shape_;
  shape.segment = segment;
  shape.transition = transition;
  shape.samples = samples;
  for (std::size_t u = 0; u < words.size(); ++u) foci(session_.frame(u), shape, words[u], index);
  return session_.send();
}

bool Output::begin(TurnClock* turns) {
  audible_until_ = {};
  if (!session_.prepare(turns)) return false;
  silencer(session_.frame(0), shape_.divider);
  if (!session_.exchange_for_all()) return false;
  // a modulation begins while this input is high: keep it high, so that modulations begin at once
  gpio(session_.frame(0), 1);
  if (!session_.exchange_for_all()) return false;
  // silence applies before anything can be audible
  modulation_ = 0;
  return send_modulation({});
}

bool Output::send_modulation(const SoundingTime& time, Clock::time_point latest) {
  std::array<std::uint8_t, kMostModulation> levels;
  const int count = write_dead_man(time, kRamp, modulation_sample(), levels);
  modulation_ = 1 - modulation_;
  modulation(session_.frame(0), std::span(levels).first(static_cast<std::size_t>(count)),
             modulation_, modulation_divider_);
  return session_.exchange_for_all(latest);
}

/// Times of a modulation that begins now and makes output audible from `next` to `end`.
/// @param slow_frame longest time that its frame takes [s].
SoundingTime Output::times_of(Clock::time_point now, Clock::time_point next, Clock::time_point end,
                              double slow_frame) const {
  SoundingTime time;
  time.next = std::max(0.0, Seconds(next - now).count());
  time.end = std::min(Seconds(end - now).count() - early(slow_frame), longest());
  // output that is already ramping down when this arrives falls silent first, then rises again
  time.sounds = now >= audible_from_ && now + to_duration(slow_frame) < audible_until_;
  return time;
}

bool Output::is_in_time(Clock::time_point next, Clock::time_point end) const {
  const SoundingTime time = times_of(Clock::now(), next, end, session_.slow_frame());
  return time.end > time.next + 2.0 * kRamp;
}

bool Output::sound(Clock::time_point next, Clock::time_point end) {
  constexpr int kTrials = 3;
  constexpr int kFramesToSilence = 3;
  constexpr double kReserve = 1.5;  // next frame over one that took too long
  double slow_frame = session_.slow_frame();
  const Clock::time_point latest = end - kFramesToSilence * to_duration(early(slow_frame));
  for (int trial = 0; trial < kTrials; ++trial) {
    const Clock::time_point now = Clock::now();
    const SoundingTime time = times_of(now, next, end, slow_frame);
    if (time.end <= time.next + 2.0 * kRamp) {
      if (trial == 0) return true;
      break;
    }
    if (!send_modulation(time, latest)) return false;
    if (!time.sounds) audible_from_ = now + to_duration(time.next);
    audible_until_ = now + to_duration(time.end - kRamp);
    const double taken = Seconds(Clock::now() - now).count();
    if (taken <= early(slow_frame)) return true;
    // the link is slower than when it was measured
    slow_frame = kReserve * taken;
  }
  // output may be audible for too long: silence it now
  audible_until_ = {};
  return send_modulation({});
}

bool Output::mute() {
  if (!is_audible()) return true;
  const bool sent =
      send_modulation({.sounds = true, .next = 0.0, .end = kRamp + modulation_sample()});
  audible_until_ = {};
  if (sent) std::this_thread::sleep_for(to_duration(2.0 * kRamp));
  return sent;
}

void Output::finish() {
  if (session_.is_open() && mute()) {
    clear_and_synchronise(session_.frame(0));
    session_.exchange_for_all();
  }
  session_.close();
}

}  // namespace prostm::autd3
