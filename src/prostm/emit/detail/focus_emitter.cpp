#include "prostm/emit/detail/focus_emitter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "prostm/emit/detail/envelope.hpp"
#include "prostm/emit/detail/exchange.hpp"
#include "prostm/emit/detail/matching.hpp"

namespace prostm {
namespace {

std::vector<double> envelope_of(const EmitSettings& settings, int period) {
  const Waveform waveform = settings.am_waveform;
  std::vector<double> values;
  for (int i = 0; i < period; ++i) values.push_back(envelope(waveform, i / double(period)));
  return values;
}

/// Action of all focal points at their next zeros.
enum class Next : std::uint8_t { GoOn, TakeOver, Rest };

/// A focal point plays its focus until it is assigned a new one. It then waits for a zero, moves,
/// and rises at the next zero of its new phase: the same zero if the phase has not changed.
enum class State : std::uint8_t { Plays, Waits, Rises };

/// A focal point's part in a plan.
struct Part {
  Vec3 p_D = Vec3(0.0, 0.0, 0.2);  // unused focal points rest 200 mm above the array
  double amplitude = 0.0;          // intensity at the peak
  std::size_t delay = 0;           // samples from the clock's zero to its own
  bool saturated = false;          // clipped at full scale
  bool limited = false;            // by the power limit
  bool silenced = false;           // below the silent share
};

struct Focus {
  State state = State::Plays;
  Part now, wanted;
  FocusSample last;

  bool sounds() const { return now.amplitude > 0.0; }
};

}  // namespace

struct FocusEmitter::Impl {
  Impl(Exchange& e, double sample_rate)
      : exchange(e),
        settings(e.settings),
        envelope(envelope_of(settings, am_period(settings, sample_rate))),
        stall_samples(static_cast<std::int64_t>(std::ceil(settings.stall_time * sample_rate))) {
    for (Focus& f : focus) f.last.p_D = f.now.p_D.cast<float>();
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
  std::size_t clock = 0;        // sample of the period, of all focal points
  bool stood = true;            // whether the clock paused after the last sample
  bool to_rest = false;         // waiting focal points fall silent
  bool to_begin = false;        // not all foci of the plan are audible yet
  bool fed = false;             // a plan was received and not lost since
  std::int64_t since_plan = 0;  // samples
  std::size_t to_draw = 0;      // samples of the plan's first period that are left

  std::span<Focus> foci() { return {focus.data(), static_cast<std::size_t>(settings.foci)}; }
  bool sounding() {
    return std::any_of(foci().begin(), foci().end(), [](const Focus& f) {
      return f.sounds() || (f.state == State::Rises && f.wanted.amplitude > 0.0);
    });
  }
  bool silent() {
    return std::none_of(foci().begin(), foci().end(), [](const Focus& f) { return f.sounds(); });
  }
  bool at_zero(const Focus& f) const { return f.now.delay == clock; }

  void receive(std::int64_t sample);
  void assign(std::int64_t sample);
  void place(const LiftedPlan& plan);
  void limit_power();
  void go_over();
  void rise();
  bool holds();
  void emit(std::int64_t sample, std::span<FocusSample> out);
  void write(Focus& f, FocusSample& out);
};

/// Handles the newest message, if any.
void FocusEmitter::Impl::receive(std::int64_t sample) {
  const News news = exchange.receive(stats);
  if (news == News::None) return;
  fed = news == News::Plan;
  since_plan = 0;
  next = fed ? Next::TakeOver : Next::Rest;
  if (fed) exchange.log.arrive(exchange.inbox.value().plan.id, 1.0, sample);
}

/// Assigns the plan's foci to focal points, (B5); the others fall silent where they are.
void FocusEmitter::Impl::place(const LiftedPlan& plan) {
  const std::size_t count = std::min(plan.foci.size(), foci().size());
  stats.dropped_paths += static_cast<std::int64_t>(plan.foci.size() - count);
  MatchCosts costs{};
  for (std::size_t i = 0; i < foci().size(); ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      costs[i][k] = (plan.foci[k].p_D - focus[i].now.p_D).norm();
    }
  }
  const auto match = match_paths(costs, settings.foci, static_cast<int>(count));
  for (std::size_t i = 0; i < foci().size(); ++i) {
    if (match[i] == kNoPath) continue;
    const LiftedFocus& given = plan.foci[static_cast<std::size_t>(match[i])];
    Part& part = focus[i].wanted;
    part.p_D = given.p_D;
    part.amplitude = drive_intensity(given.pressure, settings.full_scale_pressure,
                                     settings.silent_below, part.saturated);
    part.silenced = given.pressure > 0.0 && part.amplitude == 0.0;
    const auto delay = std::lround(given.phase * static_cast<double>(envelope.size()));
    part.delay = static_cast<std::size_t>(delay) % envelope.size();
  }
}

/// Scales all intensities by one factor if Σ I² at the peak exceeds the limit.
void FocusEmitter::Impl::limit_power() {
  double power = 0.0;
  for (const Focus& f : foci()) power += f.wanted.amplitude * f.wanted.amplitude;
  if (power <= settings.power_limit) return;
  const double scale = std::sqrt(settings.power_limit / power);
  for (Focus& f : foci()) {
    f.wanted.amplitude *= scale;
    f.wanted.limited = true;
  }
}

/// Sets what each focal point does from its next zero on.
void FocusEmitter::Impl::assign(std::int64_t sample) {
  exchange.log.leave(entry);
  entry = TakeOverLog::kNone;
  if (silent()) clock = 0;
  for (Focus& f : foci()) {
    f.state = State::Waits;
    f.wanted = {f.now.p_D, 0.0, f.now.delay, false, false, false};
  }
  to_rest = next == Next::Rest;
  if (!to_rest) {
    place(exchange.inbox.value().plan);
    limit_power();
    entry = exchange.log.follow(sample);
  }
  to_begin = !to_rest;
  to_draw = 0;
  next = Next::GoOn;
}

/// Moves waiting focal points that are silent in this sample and the last one to their new foci.
void FocusEmitter::Impl::go_over() {
  for (Focus& f : foci()) {
    if (f.state != State::Waits) continue;
    if (f.sounds() && !(at_zero(f) && (stood || to_rest))) continue;
    f.now = f.wanted;
    f.now.amplitude = 0.0;
    f.state = State::Rises;
  }
}

/// Sets the amplitude of rising focal points at a zero. While others still play an older plan, they
/// get only what the power limit leaves, and the rest at a later zero.
void FocusEmitter::Impl::rise() {
  double others = 0.0, risen = 0.0;  // Σ I² at the peak
  for (Focus& f : foci()) {
    const bool rises = f.state == State::Rises && at_zero(f);
    if (rises) f.now.amplitude = f.wanted.amplitude;
    (rises ? risen : others) += f.now.amplitude * f.now.amplitude;
  }
  constexpr double kRounding = 1e-9;
  const bool too_much = others + risen > settings.power_limit * (1.0 + kRounding);
  const double scale =
      too_much ? std::sqrt(std::max(0.0, settings.power_limit - others) / risen) : 1.0;
  bool all_play = true;
  for (Focus& f : foci()) {
    if (f.state == State::Rises && at_zero(f)) {
      if (too_much) f.now.amplitude *= scale;
      f.now.limited = f.wanted.limited || too_much;
      if (!too_much) f.state = State::Plays;
    }
    all_play = all_play && f.state == State::Plays;
  }
  if (to_begin && all_play) {
    to_begin = false;
    to_draw = envelope.size();
  }
}

void FocusEmitter::Impl::write(Focus& f, FocusSample& out) {
  const std::size_t n = envelope.size();
  out.p_D = f.now.p_D.cast<float>();
  out.intensity = static_cast<float>(f.now.amplitude * envelope[(clock + n - f.now.delay) % n]);
  longest_step.look(f.last, out);
  f.last = out;
  const bool sounds = out.intensity > 0.0F;
  stats.saturated += sounds && f.now.saturated ? 1 : 0;
  stats.limited += sounds && f.now.limited ? 1 : 0;
  stats.silenced += f.now.silenced ? 1 : 0;
}

/// Whether the clock pauses: a focal point at its zero moves to its new focus in the next sample.
bool FocusEmitter::Impl::holds() {
  return std::any_of(foci().begin(), foci().end(), [this](const Focus& f) {
    const bool goes_over = next == Next::TakeOver || f.state == State::Waits;
    return goes_over && f.sounds() && at_zero(f);
  });
}

/// Emits one sample of every focal point.
void FocusEmitter::Impl::emit(std::int64_t sample, std::span<FocusSample> out) {
  // silent stall
  if (fed && ++since_plan > stall_samples) {
    fed = false;
    stats.stalls += sounding() ? 1 : 0;
    next = Next::Rest;
  }

  // a plan takes over from the first zero on
  if (next != Next::GoOn) {
    const bool zero = std::any_of(foci().begin(), foci().end(),
                                  [this](const Focus& f) { return f.sounds() && at_zero(f); });
    if (silent() || (zero && (stood || next == Next::Rest))) assign(sample);
  }
  go_over();
  rise();
  for (std::size_t i = 0; i < out.size(); ++i) write(focus[i], out[i]);
  if (entry != TakeOverLog::kNone && to_draw > 0) {
    --to_draw;
    exchange.log.draw(entry, 1.0 / static_cast<double>(envelope.size()), sample);
  }

  // a zero lasts while there is nothing to modulate, and until its focal point has moved
  stood = !sounding() || holds();
  if (!stood) clock = (clock + 1) % envelope.size();
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
