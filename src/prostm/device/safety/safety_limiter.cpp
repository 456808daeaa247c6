#include "prostm/device/safety/safety_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/emit/emitter.hpp"

namespace prostm {
namespace {

constexpr float kRounding = 1e-4F;       // tolerance for the rounding of floats
constexpr float kSilence = 0.01F;        // intensity
constexpr float kFarthest = 100.0F;      // largest coordinate of a focal point [m]
constexpr double kPlaceRounding = 1e-3;  // of a step, for positions in floats
constexpr double kRampTime = 0.050, kSilenceTime = 0.100, kMuteTime = 0.010;  // [s]

// The mean over time has this time constant, so that over a second it is at most
// (1 + kMeanTime) times the largest exponential mean, (G3)
constexpr double kMeanTime = 0.1;  // [s]
constexpr float kMeanShare = static_cast<float>(0.999 / (1.0 + kMeanTime));
constexpr float kMeanGain = 4.0F;  // how fast the allowed level falls as a mean nears its cap

// Where the allowed drive exceeds kKnee, intensities pass whatever their sum
constexpr float kKnee = 1.25F, kMostDrive = 8.0F;

// for devices that take intensity as a pressure, intensity 1 is the pressure of a full drive at
// this height, as for SimulatedArray
constexpr double kFullScaleHeight = 0.2;  // [m]

/// Whether all numbers are finite and the position is near enough. Never compares a NaN.
bool is_finite(const FocusSample& s) {
  for (const float x : s.p_D)
    if (!std::isfinite(x) || std::abs(x) > kFarthest) return false;
  return std::isfinite(s.intensity);
}

/// Largest Σ of drives where a drive of `allowed` is within all caps, (G4).
float largest_sum(float allowed) {
  if (allowed <= 1.0F) return allowed;
  return 1.0F + (allowed - 1.0F) / (kKnee - 1.0F) * (kMostDrive - 1.0F);
}

float energy_share(double decibels) {
  return static_cast<float>(std::pow(10.0, 0.1 * decibels));
}

}  // namespace

SafetyLevels::SafetyLevels(const TransducerArray& array, const Medium& medium, double head_distance)
    : focus(array),
      head(head_level(array, head_distance)),
      radiation_per_square(prostm::radiation_pressure(1.0, medium)),
      share_low(smallest_amplitude(array) / largest_amplitude(array) *
                std::exp(-wave(array, medium).absorption * focus.box().diagonal().norm())),
      likely_by_low(likely_amplitude(array) / smallest_amplitude(array)),
      full_scale(static_cast<float>(full_pressure(array, Vec3(0.0, 0.0, kFullScaleHeight)))) {}

float SafetyLimiter::Mean::allowed(float cap) const {
  const float most = kMeanShare * cap;
  return std::max(0.0F, most + kMeanGain * (most - mean));
}

void SafetyLimiter::Mean::add(float now, float now_low, float weight) {
  // tiny remainders are set to 0, since subnormal numbers are slow
  constexpr float kNothing = 1e-20F;
  mean += weight * (now - mean);
  low += weight * (now_low - low);
  if (mean < kNothing) mean = 0.0F;
  if (low < kNothing) low = 0.0F;
}

SafetyLimiter::SafetyLimiter(const SampleLimits& limits)
    : limits_(limits),
      change_(static_cast<float>(limits.change) * (1.0F + kRounding)),
      power_(static_cast<float>(std::min(limits.power, limits.caps.power)) * (1.0F + kRounding)),
      step_(static_cast<float>(kMaxFocusSpeed / limits.sample_rate * (1.0 + kPlaceRounding))),
      ramp_(static_cast<float>(1.0 / (kRampTime * limits.sample_rate))),
      mute_fall_(static_cast<float>(1.0 / (kMuteTime * limits.sample_rate))),
      weight_(static_cast<float>(1.0 / (kMeanTime * limits.sample_rate))),
      silence_(std::llround(kSilenceTime * limits.sample_rate)),
      ceiling_(kSilence) {
  require_bounds(limits.caps);
  if (limits_.levels)
    head_cap_ = energy_share(limits_.caps.head_level - limits_.levels->head.estimate);
}

void SafetyLimiter::follow(SampleSource& from) {
  SampleStage::follow(from);
  focus_.assign(static_cast<std::size_t>(from.foci()), Focus());
}

void SafetyLimiter::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  from().fill(first, out);
  for (std::size_t at = 0; at < out.size(); at += focus_.size())
    limit(out.subspan(at, focus_.size()));
  publish();
}

/// Limits one sample of all focal points.
void SafetyLimiter::limit(std::span<FocusSample> now) noexcept {
  // limits on each focal point by itself
  const bool muted = mute_ && mute_->on();
  for (std::size_t f = 0; f < now.size(); ++f) clean(f, now[f]);
  advance_ramps(now, muted);
  const float ceiling = std::min(ceiling_, unmuted_);
  for (std::size_t f = 0; f < now.size(); ++f) {
    float& intensity = now[f].intensity;
    if (intensity > ceiling) {
      intensity = ceiling;
      count(SafetyLimit::Ramp);
    }
    const float last = focus_[f].last.intensity;
    intensity = std::clamp(intensity, last - change_, last + change_);
  }

  // limits on all of them together
  if (holding_) {
    hold_all(now, held_for_);
  } else if (!hold_jumps(now)) {
    keep_caps(now);
  }
  account(now);
}

/// Whether a focal point has an intensity above 0, however small, before and after a step that is
/// too long: a device that adds phasors gives a weak one more than its share of the slots.
bool SafetyLimiter::jumps(std::size_t f, const FocusSample& now) const noexcept {
  const FocusSample& last = focus_[f].last;
  return now.intensity > 0.0F && last.intensity > 0.0F &&
         (now.p_D - last.p_D).squaredNorm() > step_ * step_;
}

/// Makes a sample finite, at a position with known levels, and not above the cap on intensity.
void SafetyLimiter::clean(std::size_t f, FocusSample& now) noexcept {
  Focus& focus = focus_[f];
  focus.wanted_pressure = focus.full_pressure;
  if (!is_finite(now)) {
    now = {focus.last.p_D, 0.0F};
    focus.given = 0.0F;
    count(SafetyLimit::NotFinite);
    return;
  }
  const float most = static_cast<float>(limits_.caps.intensity);
  if (now.intensity < 0.0F || now.intensity > 1.0F) {
    now.intensity = std::clamp(now.intensity, 0.0F, 1.0F);
    count(SafetyLimit::OutOfRange);
  }
  if (std::abs(now.intensity - focus.given) > change_) count(SafetyLimit::Change);
  focus.given = now.intensity;
  if (now.intensity > most) {
    now.intensity = most;
    count(SafetyLimit::Intensity);
  }
  if (!limits_.levels) return;
  if (limits_.levels->focus.holds(now.p_D)) {
    focus.wanted_pressure = limits_.levels->focus.pressure(now.p_D);
  } else if (now.intensity > 0.0F || focus.last.intensity > 0.0F) {
    now = {focus.last.p_D, 0.0F};
    count(SafetyLimit::Place);
  } else {
    focus.wanted_pressure = 0.0F;
  }
}

/// Advances the ramps that limit output after the start, after silence, and around a mute.
void SafetyLimiter::advance_ramps(std::span<const FocusSample> wanted, bool muted) noexcept {
  unmuted_ = std::clamp(unmuted_ + (muted ? -mute_fall_ : mute_fall_), 0.0F, 1.0F);
  const bool sounds = std::any_of(wanted.begin(), wanted.end(),
                                  [](const FocusSample& s) { return s.intensity > kSilence; });
  if (sounds && unmuted_ > 0.0F) {
    silent_ = 0;
    ceiling_ = std::min(1.0F, ceiling_ + ramp_);
  } else if (++silent_ >= silence_) {
    ceiling_ = kSilence;
  }
}

/// Returns the level of a sample, with the pressures at its positions from `wanted_pressure`.
SafetyLimiter::Level SafetyLimiter::level(std::span<const FocusSample> samples) const noexcept {
  Level level;
  const float full_scale = limits_.levels->full_scale;
  float sum = 0.0F, stretch = 1.0F, squares = 0.0F, own = 0.0F;
  for (std::size_t f = 0; f < samples.size(); ++f) {
    const float intensity = samples[f].intensity, full = focus_[f].wanted_pressure;
    if (intensity <= 0.0F) continue;
    sum += intensity;
    squares += intensity * intensity;
    own = std::max(own, intensity * full);
    level.pressure = std::max(level.pressure, full);
    // a device that takes intensity as a pressure drives harder for a position further away; full
    // is above 0 where levels are known, and clean() has replaced any other position
    if (full * stretch < full_scale) stretch = full_scale / full;
  }
  level.drive = sum * stretch;
  const float shared = 1.0F / std::max(1.0F, sum);
  level.own = own * shared;
  level.energy = squares * shared * shared;
  return level;
}

/// Returns the largest drive within all caps, if a full drive makes this pressure [Pa]; above 1:
/// any drive.
SafetyLimiter::Allowed SafetyLimiter::cap_drive(float pressure) const noexcept {
  const SafetySettings& caps = limits_.caps;
  const float radiation =
      static_cast<float>(limits_.levels->radiation_per_square) * pressure * pressure;
  const float acoustic = static_cast<float>(caps.acoustic_pressure) / pressure;
  // bounds on the square of the drive
  const std::array<Allowed, 4> squares = {{
      {acoustic * acoustic, SafetyLimit::AcousticPressure},
      {static_cast<float>(caps.radiation_pressure) / radiation, SafetyLimit::RadiationPressure},
      {radiation_.allowed(static_cast<float>(caps.mean_radiation_pressure)) / radiation,
       SafetyLimit::MeanRadiationPressure},
      {head_.allowed(head_cap_), SafetyLimit::HeadLevel},
  }};
  const Allowed least = std::ranges::min(squares, {}, &Allowed::most);
  return {std::sqrt(least.most), least.limit};
}

/// Returns the factor on all intensities that keeps power and caps; at most 1.
SafetyLimiter::Allowed SafetyLimiter::scale(std::span<const FocusSample> now) const noexcept {
  float power = 0.0F;
  for (const FocusSample& sample : now) power += sample.intensity * sample.intensity;
  const bool strong = power > power_;
  const Allowed by_power{strong ? std::sqrt(power_ / (1.0F + kRounding) / power) : 1.0F,
                         SafetyLimit::Power};
  if (!limits_.levels) return by_power;
  const Level wanted = level(now);
  if (wanted.drive <= 0.0F) return by_power;
  const Allowed cap = cap_drive(wanted.pressure);
  if (cap.most >= kKnee) return by_power;
  const Allowed by_cap{largest_sum(cap.most) / wanted.drive, cap.limit};
  return by_cap.most < by_power.most ? by_cap : by_power;
}

/// Fades out each focal point that jumps, at its last position. @return whether all are held,
/// because the device has one intensity for all.
bool SafetyLimiter::hold_jumps(std::span<FocusSample> now) noexcept {
  for (std::size_t f = 0; f < now.size(); ++f) {
    if (!jumps(f, now[f])) continue;
    if (limits_.one_intensity) {
      hold_all(now, SafetyLimit::Jump);
      return true;
    }
    hold(f, now[f]);
    count(SafetyLimit::Jump);
  }
  return false;
}

/// Lowers all intensities as far as the caps require.
void SafetyLimiter::keep_caps(std::span<FocusSample> now) noexcept {
  const auto [share, reason] = scale(now);
  if (share >= 1.0F) return;
  for (std::size_t f = 0; f < now.size(); ++f) {
    if (share * now[f].intensity < focus_[f].last.intensity - change_) return hold_all(now, reason);
  }
  for (FocusSample& sample : now) sample.intensity *= share;
  count(reason, static_cast<std::int64_t>(now.size()));
}

/// Fades out a focal point at its last position.
void SafetyLimiter::hold(std::size_t f, FocusSample& now) noexcept {
  Focus& focus = focus_[f];
  now = {focus.last.p_D, std::max(0.0F, focus.last.intensity - change_)};
  focus.wanted_pressure = focus.full_pressure;
}

/// Fades out all focal points at their last positions, which were within all caps.
void SafetyLimiter::hold_all(std::span<FocusSample> now, SafetyLimit reason) noexcept {
  for (std::size_t f = 0; f < now.size(); ++f) hold(f, now[f]);
  holding_ = std::ranges::any_of(now, [](const FocusSample& s) { return s.intensity > 0.0F; });
  held_for_ = reason;
  count(reason, static_cast<std::int64_t>(now.size()));
}

/// Records the sample that is sent, and its levels.
void SafetyLimiter::account(std::span<const FocusSample> now) noexcept {
  for (std::size_t f = 0; f < now.size(); ++f) {
    focus_[f].last = now[f];
    focus_[f].full_pressure = focus_[f].wanted_pressure;
  }
  if (!limits_.levels) return;
  const Level made = level(now);
  const float drive = std::min(1.0F, made.drive), square = drive * drive;
  const float radiation = static_cast<float>(limits_.levels->radiation_per_square);
  const float pressure = drive * made.pressure;
  const float low = static_cast<float>(limits_.levels->share_low) * made.own;
  radiation_.add(radiation * pressure * pressure, radiation * low * low, weight_);
  head_.add(square, made.energy, weight_);
  acoustic_high_ = std::max(acoustic_high_, pressure);
  acoustic_low_ = std::max(acoustic_low_, low);
  mean_high_ = std::max(mean_high_, radiation_.mean);
  mean_low_ = std::max(mean_low_, radiation_.low);
  head_high_ = std::max(head_high_, head_.mean);
  head_low_ = std::max(head_low_, head_.low);
}

void SafetyLimiter::publish() noexcept {
  for (std::size_t i = 0; i < kSafetyLimits; ++i)
    published_counts_[i].store(counts_[i], std::memory_order_relaxed);
  const std::array<float, 6> levels = {acoustic_low_, acoustic_high_, mean_low_,
                                       mean_high_,    head_low_,      head_high_};
  for (std::size_t i = 0; i < levels.size(); ++i)
    published_levels_[i].store(levels[i], std::memory_order_relaxed);
}

}  // namespace prostm
