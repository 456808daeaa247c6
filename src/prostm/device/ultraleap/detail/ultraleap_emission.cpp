#if defined(PROSTM_ULTRALEAP)
#include "prostm/device/ultraleap/detail/ultraleap_emission.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

namespace ulh = Ultraleap::Haptics;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kAtOnce = 256;     // samples pulled from the source at a time
constexpr double kRateTolerance = 0.01;  // of the interval between samples
constexpr double kLongestFade = 0.1;     // longest wait of fade_out() [s]
constexpr double kStalled = 1.0;         // time without a call that suggests a stall [s]
constexpr double kDoubt = 0.1;           // further time until the stall counts as a fault [s]
constexpr double kNoCalls = 0.02;        // time without a call after which fade_out() returns [s]

double seconds_now() {
  return Seconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

void UltraleapEmission::start(SampleSource& source, const Setup& setup) {
  source_ = &source;
  setup_ = setup;
  const int fade = std::max(1, static_cast<int>(std::ceil(setup.fade_time * setup.rate)));
  fade_step_ = 1.0F / static_cast<float>(fade);
  gate_.configure(setup.foci, {.least_separation = setup.least_separation, .fade = fade});
  const auto foci = static_cast<std::size_t>(setup.foci);
  block_.assign(kAtOnce * foci, FocusSample());
  now_.assign(foci, FocusSample());
  points_ = foci;
  at_ = end_ = 0;
  pulled_ = emitted_ = 0;
  gain_ = 0.0F;
  log_.reset(setup.rate);
  late_ = 0;
  fault_ = Fault::None;
  silent_from_ = 0.0;
  wanted_ = 1.0F;
  last_call_ = seconds_now();
  open_ = true;
}

/// Fades out and records the fault, if it is the first.
void UltraleapEmission::fail(Fault fault) {
  wanted_ = 0.0F;
  Fault none = Fault::None;
  fault_.compare_exchange_strong(none, fault);
}

void UltraleapEmission::watch() {
  const double now = seconds_now();
  if (!open_ || now - last_call_ <= kStalled) return;
  // a process that was suspended for a second must get time to be called back
  if (suspected_ <= last_call_) {
    suspected_ = now;
  } else if (now - suspected_ > kDoubt) {
    fail(Fault::Stalled);
  }
}

void UltraleapEmission::fade_out() {
  mute();
  const double begin = seconds_now();
  for (double now = begin; now < begin + kLongestFade; now = seconds_now()) {
    const double silent = silent_from_.load(std::memory_order_acquire);
    if (silent > 0.0 && silent <= now) return;
    if (now - log_.newest().time > kNoCalls) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

void UltraleapEmission::stop() {
  wanted_ = 0.0F;
  open_ = false;
  // a callback may be running: wait until it has returned; later ones find open_ false
  while (inside_) std::this_thread::yield();
}

void UltraleapEmission::callback(const ulh::StreamingEmitter& /*emitter*/,
                                 ulh::OutputInterval& interval, const ulh::LocalTimePoint& deadline,
                                 void* emission) noexcept {
  auto* self = static_cast<UltraleapEmission*>(emission);
  if (self == nullptr) return;
  self->inside_ = true;
  try {
    if (self->open_) {
      self->emit(interval, deadline);
    } else {
      self->fill_silence(interval);
    }
  } catch (...) {
    // an exception must not reach the SDK's thread
    self->fail(Fault::Sdk);
  }
  self->inside_ = false;
}

/// Fills an interval with silence; uses nothing that start() prepares.
void UltraleapEmission::fill_silence(ulh::OutputInterval& interval) {
  const std::size_t points = points_;
  for (ulh::TimePointOnOutputInterval& point : interval) {
    for (std::size_t f = 0; f < points; ++f) point.controlPoint(f).setIntensity(0.0F);
  }
}

/// Estimates the number of samples in an interval; only iterating over it gives the exact number.
std::size_t UltraleapEmission::expected(const ulh::OutputInterval& interval) const {
  const Seconds length = interval.intervalEnd() - interval.firstSample();
  const double samples = std::round(length.count() * setup_.rate);
  return static_cast<std::size_t>(std::clamp(samples, 1.0, static_cast<double>(kAtOnce)));
}

/// Pulls samples from the source.
void UltraleapEmission::pull(std::size_t samples) {
  source_->fill(pulled_, std::span(block_).first(samples * now_.size()));
  pulled_ += static_cast<std::int64_t>(samples);
  at_ = 0;
  end_ = samples;
}

/// Sets the control points of one time point to the current sample.
void UltraleapEmission::set_points(ulh::TimePointOnOutputInterval& point) {
  gain_ += std::clamp(wanted_.load(std::memory_order_relaxed) - gain_, -fade_step_, fade_step_);
  for (std::size_t f = 0; f < now_.size(); ++f) {
    ulh::ControlPoint& control = point.controlPoint(f);
    const Eigen::Vector3f& p_D = now_[f].p_D;
    control.setPosition(ulh::Vector3(p_D.x(), p_D.y(), p_D.z()));
    control.setIntensity(now_[f].intensity * gain_);
  }
}

void UltraleapEmission::emit(ulh::OutputInterval& interval, const ulh::LocalTimePoint& deadline) {
  const ulh::LocalTimePoint begin = ulh::LocalTimeClock::now();
  PlayLog::Call call{.first = emitted_, .pulled = pulled_, .time = seconds_now()};
  last_call_ = call.time;
  const double step = Seconds(interval.iteratorTimeInterval()).count();
  if (std::abs(step * setup_.rate - 1.0) > kRateTolerance && fault() == Fault::None) {
    found_interval_ = step;
    fail(Fault::Rate);
  }
  const auto foci = static_cast<std::size_t>(setup_.foci);
  const auto ahead = static_cast<std::size_t>(gate_.delay());
  std::size_t left = expected(interval) + (pulled_ == 0 ? ahead : 0);
  left -= std::min(left, end_ - at_);  // some may be left from the last call
  for (ulh::TimePointOnOutputInterval& point : interval) {
    if (call.samples == 0) call.play_time = call.time + Seconds(point - begin).count();
    // the first samples only fill the delay line of the gate
    for (;;) {
      if (at_ == end_) {
        pull(std::clamp<std::size_t>(left, 1, kAtOnce));
        left -= std::min(left, end_);
      }
      const bool first_ones = at_ + static_cast<std::size_t>(pulled_) - end_ < ahead;
      gate_.step(std::span(block_).subspan(at_ * foci, foci), now_);
      ++at_;
      if (!first_ones) break;
    }
    set_points(point);
    ++call.samples;
    if (gain_ == 0.0F && wanted_ == 0.0F && silent_from_ == 0.0) {
      silent_from_.store(call.time + Seconds(point - begin).count(), std::memory_order_release);
    }
  }
  emitted_ += call.samples;
  log_.add(call);
  if (ulh::LocalTimeClock::now() > deadline) late_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace prostm
#endif
