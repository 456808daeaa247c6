#include "prostm/emit/detail/focus_emitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "prostm/core/require.hpp"
#include "prostm/emit/detail/envelope.hpp"
#include "prostm/emit/detail/exchange.hpp"
#include "prostm/emit/detail/matching.hpp"

namespace prostm {
namespace {

// Both waveforms change by at most π/n a sample: with n = 126 by less than 1/40
constexpr double kShortestPeriod = 126.0;  // [samples]
constexpr double kLowestFrequency = 25.0;  // [Hz], so that a loss is silent within 40 ms

int period_samples(const EmitSettings& settings, double sample_rate) {
  require_between("sample_rate", sample_rate, kShortestPeriod * kLowestFrequency, 1e6, "Hz");
  require_between("am_frequency", settings.am_frequency, kLowestFrequency,
                  sample_rate / kShortestPeriod, "Hz");
  return static_cast<int>(std::lround(sample_rate / settings.am_frequency));
}

std::vector<double> envelope_of(const EmitSettings& settings, int period) {
  const Waveform waveform = settings.am_waveform;
  std::vector<double> values;
  for (int i = 0; i < period; ++i) values.push_back(envelope(waveform, i / double(period)));
  return values;
}

/// Action of the focal points at the next zero of the envelope.
enum class Next : std::uint8_t { GoOn, TakeOver, Rest };

struct Focus {
  Vec3 p_D = Vec3(0.0, 0.0, 0.2);  // unused focal points rest 200 mm above the array
  double amplitude = 0.0;          // intensity at the peak
  bool saturated = false;          // clipped at full scale
  FocusSample last;
};

}  // namespace

struct FocusEmitter::Impl {
  Impl(Exchange& e, double sample_rate)
      : exchange(e),
        settings(e.settings),
        envelope(envelope_of(settings, period_samples(settings, sample_rate))),
        stall_samples(static_cast<std::int64_t>(std::ceil(settings.stall_time * sample_rate))) {
    for (Focus& f : focus) f.last.p_D = f.p_D.cast<float>();
  }

  Exchange& exchange;

  // constant
  const EmitSettings& settings;
  const std::vector<double> envelope;  // one period
  const std::int64_t stall_samples;

  // device's thread
  std::array<Focus, kMaxPaths> focus;
  EmitStats stats;
  LongestStep longest_step;
  TakeOverLog::Entry entry = TakeOverLog::kNone;
  Next next = Next::GoOn;
  std::size_t phase = 0;        // envelope index of the next sample
  bool silent = true;           // whether the last sample was silent
  bool sounding = false;        // some amplitude is above 0
  bool limited = false;         // by the power limit
  bool fed = false;             // a plan came and was not lost since
  std::int64_t since_plan = 0;  // samples
  std::size_t to_draw = 0;      // samples of the plan's first period that are left

  std::span<Focus> foci() { return {focus.data(), static_cast<std::size_t>(settings.foci)}; }

  void receive(std::int64_t sample);
  void take_over(std::int64_t sample);
  void place(const LiftedPlan& plan);
  void limit_power();
  void emit(std::int64_t sample, std::span<FocusSample> out);
  void write(Focus& f, double a, FocusSample& out);
};

/// Acts on the newest message, if one came.
void FocusEmitter::Impl::receive(std::int64_t sample) {
  const News news = exchange.receive(stats);
  if (news == News::None) return;
  fed = news == News::Plan;
  since_plan = 0;
  next = fed ? Next::TakeOver : Next::Rest;
  if (fed) exchange.log.arrive(exchange.inbox.value().plan.id, 1.0, sample);
}

/// Gives each focal point its focus of the plan, (B5); the others fall silent where they are.
void FocusEmitter::Impl::place(const LiftedPlan& plan) {
  const std::size_t count = std::min(plan.foci.size(), foci().size());
  stats.dropped_paths += static_cast<std::int64_t>(plan.foci.size() - count);
  MatchCosts costs{};
  for (std::size_t i = 0; i < foci().size(); ++i) {
    for (std::size_t k = 0; k < count; ++k) costs[i][k] = (plan.foci[k].p_D - focus[i].p_D).norm();
  }
  const auto match = match_paths(costs, settings.foci, static_cast<int>(count));
  for (std::size_t i = 0; i < foci().size(); ++i) {
    Focus& f = focus[i];
    f.amplitude = 0.0;
    f.saturated = false;
    if (match[i] == kNoPath) continue;
    const LiftedFocus& wanted = plan.foci[static_cast<std::size_t>(match[i])];
    f.p_D = wanted.p_D;
    f.amplitude = drive_intensity(wanted.pressure, settings.full_scale_pressure,
                                  settings.silent_below, f.saturated);
  }
}

/// Scales all by one factor if Σ I² at the peak exceeds the limit.
void FocusEmitter::Impl::limit_power() {
  double power = 0.0;
  for (const Focus& f : foci()) power += f.amplitude * f.amplitude;
  sounding = power > 0.0;
  limited = power > settings.power_limit;
  if (!limited) return;
  const double scale = std::sqrt(settings.power_limit / power);
  for (Focus& f : foci()) f.amplitude *= scale;
}

void FocusEmitter::Impl::take_over(std::int64_t sample) {
  exchange.log.leave(entry);
  entry = TakeOverLog::kNone;
  if (next == Next::TakeOver) {
    place(exchange.inbox.value().plan);
    limit_power();
    entry = exchange.log.follow(sample);
    to_draw = envelope.size();
  } else {
    for (Focus& f : foci()) f.amplitude = 0.0;
    sounding = limited = false;
  }
  next = Next::GoOn;
}

void FocusEmitter::Impl::write(Focus& f, double a, FocusSample& out) {
  out.p_D = f.p_D.cast<float>();
  out.intensity = static_cast<float>(f.amplitude * a);
  longest_step.look(f.last, out);
  f.last = out;
  const bool sounds = out.intensity > 0.0F;
  stats.saturated += sounds && f.saturated ? 1 : 0;
  stats.limited += sounds && limited ? 1 : 0;
}

/// Emits one sample of every focal point.
void FocusEmitter::Impl::emit(std::int64_t sample, std::span<FocusSample> out) {
  // silent stall
  if (fed && ++since_plan > stall_samples) {
    fed = false;
    stats.stalls += sounding ? 1 : 0;
    next = Next::Rest;
  }

  // between two silent samples
  if (phase == 0 && silent && next != Next::GoOn) take_over(sample);
  for (std::size_t i = 0; i < out.size(); ++i) write(focus[i], envelope[phase], out[i]);
  if (entry != TakeOverLog::kNone && to_draw > 0) {
    --to_draw;
    exchange.log.draw(entry, 1.0 / static_cast<double>(envelope.size()), sample);
  }

  // the zero lasts while there is nothing to modulate, and until a waiting plan has taken over
  silent = phase == 0;
  if (sounding && (phase > 0 || next == Next::GoOn)) phase = (phase + 1) % envelope.size();
}

FocusEmitter::FocusEmitter(const EmitSettings& settings, double sample_rate)
    : Emitter(settings, sample_rate, Method::Am),
      impl_(std::make_unique<Impl>(exchange(), sample_rate)) {}

FocusEmitter::~FocusEmitter() = default;

int FocusEmitter::period() const {
  return static_cast<int>(impl_->envelope.size());
}

void FocusEmitter::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  exchange().fill(*impl_, first, out);
}

}  // namespace prostm
