#include "prostm/emit/detail/path_emitter.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstddef>
#include <limits>

#include "prostm/emit/detail/exchange.hpp"
#include "prostm/emit/detail/focus_motion.hpp"
#include "prostm/emit/detail/in_step.hpp"
#include "prostm/emit/detail/loop_clock.hpp"
#include "prostm/emit/detail/matching.hpp"
#include "prostm/emit/detail/start_place.hpp"
#include "prostm/emit/drive.hpp"
#include "prostm/emit/played_plan.hpp"

namespace prostm {
namespace {

constexpr double kLongestLap = 1.0;  // a new plan waits for a lap up to this long [s]

enum class State : std::uint8_t {
  Resting,    // silent, on no path
  Following,  // on a path
  Leaving     // fading to silence, then on to the next path or to rest
};

struct Focus {
  State state = State::Resting;
  FocusMotion motion;
  bool has_next = false;  // a newer plan decides what follows this lap …
  int next = kNoPath;     // … the path of it to follow, or kNoPath
  bool in_fade = false;   // until the intensity reaches that of its path
  bool jumped = false;    // whether it jumped in this sample
  TakeOverLog::Entry entry = TakeOverLog::kNone;
  std::int64_t to_draw = 0;  // samples of the path not drawn yet
  FocusSample last;
};

/// Returns where a focal point at `from` would join a path: at the place that corresponds to the
/// loop's clock, or else at the nearest place.
PathPlace meeting_place(const LiftedPath& path, const InStep& in_step, const Vec3& from) {
  if (in_step.samples == 0) return nearest_place(path, from);
  PathPlace place = place_in_step(path, in_step);
  place.distance = (place.p_D - from).norm();
  return place;
}

}  // namespace

struct PathEmitter::Impl {
  Impl(Exchange& e, double rate, double fastest);

  Exchange& exchange;

  // constant
  const EmitSettings& settings;
  const bool at_once;                             // switch_at = "now"
  const double sample_rate, max_speed, max_step;  // [Hz], [m/s], [m]
  const double fade_slew, stall_slew;
  const std::int64_t stall_samples, longest_lap;

  // device's thread
  std::array<Focus, kMaxPaths> focus;
  std::array<Drive, kMaxPaths> drive;
  EmitStats stats;
  LongestStep longest_step;
  bool fed = false;             // a plan was received and not lost since
  std::int64_t since_plan = 0;  // samples
  InStep loop;                  // of the newest plan
  LoopClock clock;

  std::span<Focus> foci() { return {focus.data(), static_cast<std::size_t>(settings.foci)}; }
  const LiftedPlan& plan() const { return exchange.inbox.value().plan; }

  /// Whether it switches to a new plan only at the end of its lap.
  bool waits(const Focus& f) const {
    return !at_once && (f.motion.is_in_step() || f.motion.lap_samples() <= longest_lap);
  }
  /// Whether it follows a loop that the newest plan does not have.
  bool in_another_loop(const Focus& f) const {
    return f.state == State::Following && f.motion.is_in_step() && f.motion.base() != loop.base;
  }
  /// Whether it can begin its part in the newest plan now.
  bool ready(const Focus& f) const {
    return f.next == kNoPath || loop.samples == 0 || clock.fits(loop);
  }

  void receive(std::int64_t sample);
  void assign(std::int64_t sample);
  void wind();
  InStep part(const LiftedPath& path, std::int64_t count) const;
  std::int64_t time_left(const Focus& f) const;
  std::int64_t time_to_loop() const;
  double cost(const Focus& f, const LiftedPath& path, std::int64_t to_loop) const;
  void release();
  bool join(Focus& f, std::int64_t sample);
  void jump(Focus& f, std::int64_t sample);
  PathPlace start_place(const Focus& f, const LiftedPath& path) const;
  void adopt(Focus& f, std::int64_t sample);
  void take_over(Focus& f, Drive& d, std::int64_t sample);
  void cut_lap(const Focus& f);
  void move(Focus& f, Drive& d, std::int64_t sample);
  void emit(std::int64_t sample, std::span<FocusSample> out);
  void count(Focus& f, const Drive& d, std::int64_t sample);
};

PathEmitter::Impl::Impl(Exchange& e, double rate, double fastest)
    : exchange(e),
      settings(e.settings),
      at_once(settings.switch_at == SwitchAt::Now),
      sample_rate(rate),
      max_speed(fastest),
      max_step(fastest / rate * kStepMargin),
      fade_slew(largest_slew(settings.fade_time, rate)),
      stall_slew(largest_slew(settings.stall_fade_time, rate)),
      stall_samples(static_cast<std::int64_t>(std::ceil(settings.stall_time * rate))),
      longest_lap(static_cast<std::int64_t>(kLongestLap * rate)) {
  for (Focus& f : focus) {
    f.motion.configure(sample_rate, max_step);
    f.last.p_D = f.motion.position().cast<float>();
  }
}

/// Handles the newest message, if any.
void PathEmitter::Impl::receive(std::int64_t sample) {
  const News news = exchange.receive(stats);
  if (news == News::None) return;
  if (news == News::Lost) {
    fed = false;
    release();
    return;
  }
  fed = true;
  since_plan = 0;
  loop = shared_loop(plan(), sample_rate, max_step);
  stats.changed_paths += played_plan(plan(), sample_rate, max_speed).changed_paths();
  if (std::none_of(foci().begin(), foci().end(), [](const Focus& f) {
        return f.state != State::Resting && f.motion.is_in_step();
      })) {
    clock.stop();
  }
  assign(sample);
  wind();

  // a focal point that is already fading, or need not wait, switches at once if it can
  for (std::size_t i = 0; i < foci().size(); ++i) {
    Focus& f = focus[i];
    if (f.state == State::Leaving) {
      drive[i].max_fall = fade_slew;
      if (f.next != kNoPath && ready(f)) join(f, sample);
    } else if (f.state == State::Following && !waits(f) && ready(f)) {
      cut_lap(f);
      take_over(f, drive[i], sample);
    }
  }
}

/// Starts the loop of the newest plan once the loop in progress has ended.
void PathEmitter::Impl::wind() {
  if (loop.samples == 0 || clock.fits(loop)) return;
  bool ends = false;
  for (const Focus& f : foci()) {
    if (!in_another_loop(f)) continue;
    if (waits(f) && !f.motion.may_leave()) return;
    ends = true;
  }
  clock.stop();
  if (ends) clock.begin_last(loop);
}

/// Returns a path's part in the loop of the newest plan, at this count of the clock.
InStep PathEmitter::Impl::part(const LiftedPath& path, std::int64_t count) const {
  InStep in_step = with_laps(loop, path, sample_rate, max_step);
  in_step.count = count;
  return in_step;
}

/// Samples until a focal point may switch to a new plan.
std::int64_t PathEmitter::Impl::time_left(const Focus& f) const {
  return f.state == State::Following && waits(f) ? f.motion.samples_left() : 0;
}

/// Samples until the loop of the newest plan begins; negative once it has begun.
std::int64_t PathEmitter::Impl::time_to_loop() const {
  if (loop.samples == 0) return 0;
  if (clock.runs() && clock.fits(loop)) return -clock.last();
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  for (const Focus& f : std::span(focus.data(), static_cast<std::size_t>(settings.foci))) {
    if (in_another_loop(f)) return time_left(f);
    first = std::min(first, time_left(f));
  }
  return first;
}

/// Cost of a take-over in (E5) [m]: the distance to move, or an equivalent for a fade.
/// @param to_loop samples until the loop of the plan begins.
double PathEmitter::Impl::cost(const Focus& f, const LiftedPath& path, std::int64_t to_loop) const {
  constexpr double kFadeUp = FocusMotion::kMaxOffset, kFadeBoth = 2.0 * kFadeUp;
  if (f.state == State::Resting) return kFadeUp;
  const bool at_lap_end = f.state == State::Following && waits(f);
  const Vec3 from = at_lap_end ? f.motion.leaving_place() : f.motion.position();
  const InStep in_step = part(path, std::max<std::int64_t>(0, time_left(f) - to_loop));
  const PathPlace place = meeting_place(path, in_step, from);
  return f.motion.reaches(path, place, in_step) ? place.distance : kFadeBoth;
}

/// Assigns each focal point its part in the newest plan.
void PathEmitter::Impl::assign(std::int64_t sample) {
  const std::size_t paths = std::min(plan().paths.size(), foci().size());
  stats.dropped_paths += static_cast<std::int64_t>(plan().paths.size() - paths);

  MatchCosts costs{};
  const std::int64_t to_loop = time_to_loop();
  double total_length = 0.0;
  for (std::size_t p = 0; p < paths; ++p) total_length += plan().paths[p].length;
  for (std::size_t i = 0; i < foci().size(); ++i) {
    for (std::size_t p = 0; p < paths; ++p) {
      costs[i][p] = cost(focus[i], plan().paths[p], to_loop);
    }
    costs[i][kMaxPaths] = focus[i].state == State::Resting ? 0.0 : FocusMotion::kMaxOffset;
  }
  const auto match = match_paths(costs, settings.foci, static_cast<int>(paths));
  for (std::size_t i = 0; i < foci().size(); ++i) {
    focus[i].has_next = true;
    focus[i].next = match[i];
  }
  exchange.log.arrive(plan().id, total_length, sample);
}

/// Lets every focal point fade out and rest.
void PathEmitter::Impl::release() {
  for (std::size_t i = 0; i < foci().size(); ++i) {
    Focus& f = focus[i];
    f.has_next = true;
    f.next = kNoPath;
    if (f.state == State::Resting) continue;
    if (f.state == State::Following) cut_lap(f);
    f.state = State::Leaving;
    f.in_fade = false;
    drive[i].max_fall = stall_slew;
  }
}

void PathEmitter::Impl::cut_lap(const Focus& f) {
  if (!f.motion.at_rest() && !f.motion.lap_ended()) ++stats.laps_cut;
}

/// Switches to the next path by moving; false if it is too far away. @pre next is a path; ready(f).
bool PathEmitter::Impl::join(Focus& f, std::int64_t sample) {
  const LiftedPath& path = plan().paths[static_cast<std::size_t>(f.next)];
  const InStep in_step = part(path, clock.runs() ? clock.last() : 0);
  const PathPlace place = meeting_place(path, in_step, f.motion.position());
  if (!f.motion.reaches(path, place, in_step)) return false;
  if (loop.samples > 0 && !clock.runs()) clock.begin_last(loop);
  f.motion.join(path, place, in_step);
  adopt(f, sample);
  return true;
}

/// Returns where a silent focal point begins a path: at its first point, as planned, or, if other
/// focal points are running already, at the place that keeps it away from them.
PathPlace PathEmitter::Impl::start_place(const Focus& f, const LiftedPath& path) const {
  boost::container::static_vector<const FocusMotion*, kMaxPaths> others;
  bool any_runs = false;
  for (int i = 0; i < settings.foci; ++i) {
    const Focus& other = focus[static_cast<std::size_t>(i)];
    if (&other == &f || other.state != State::Following) continue;
    others.push_back(&other.motion);
    any_runs = any_runs || !other.jumped;
  }
  if (!any_runs) return first_place(path);
  return place_apart(path, f.motion,
                     std::span<const FocusMotion* const>(others.data(), others.size()));
}

/// Jumps to the next path, or to rest, while silent.
void PathEmitter::Impl::jump(Focus& f, std::int64_t sample) {
  f.has_next = false;
  if (f.next == kNoPath) {
    exchange.log.leave(f.entry);
    f.entry = TakeOverLog::kNone;
    f.state = State::Resting;
    f.in_fade = false;
    return;
  }
  const LiftedPath& path = plan().paths[static_cast<std::size_t>(f.next)];
  if (loop.samples > 0 && !clock.runs()) clock.begin_next(loop);
  const InStep in_step = part(path, clock.last() + 1);
  f.motion.jump(path, loop.samples > 0 ? place_in_step(path, in_step) : start_place(f, path),
                in_step);
  f.in_fade = f.jumped = true;
  adopt(f, sample);
}

void PathEmitter::Impl::adopt(Focus& f, std::int64_t sample) {
  exchange.log.leave(f.entry);
  f.entry = exchange.log.follow(sample);
  f.has_next = false;
  f.state = State::Following;
  f.to_draw = f.motion.lap_samples();
  if (!f.motion.at_rest()) ++stats.laps_started;
}

/// Starts the transition to the next path or to rest: by moving if the path is near, else by
/// fading.
void PathEmitter::Impl::take_over(Focus& f, Drive& d, std::int64_t sample) {
  if (f.next != kNoPath && join(f, sample)) return;
  f.state = State::Leaving;
  f.in_fade = true;
  d.max_fall = fade_slew;
}

/// Moves one focal point to its next sample: take-over, position, and wanted intensity.
void PathEmitter::Impl::move(Focus& f, Drive& d, std::int64_t sample) {
  d.wanted = 0.0;
  f.jumped = false;
  if (f.state == State::Following && f.has_next && f.motion.may_leave() && ready(f)) {
    take_over(f, d, sample);
  } else if (f.state == State::Following && f.motion.lap_ended() && !f.motion.at_rest()) {
    ++stats.laps_started;
  }

  // if silent, jump to the next path; this sample stays silent, so that the jump is not felt
  if (f.state != State::Following && d.intensity <= 0.0) {
    if (f.has_next && ready(f)) jump(f, sample);
  }
  if (f.jumped || f.state == State::Resting) return;

  // along the path
  const double pressure = f.motion.advance();
  if (f.state == State::Leaving) return;
  bool saturated = false;
  d.wanted =
      drive_intensity(pressure, settings.full_scale_pressure, settings.silent_below, saturated);
  d.max_fall = fade_slew;
  stats.saturated += saturated ? 1 : 0;
  stats.silenced += pressure > 0.0 && d.wanted == 0.0 ? 1 : 0;
}

/// Updates the statistics of one focal point after a sample.
void PathEmitter::Impl::count(Focus& f, const Drive& d, std::int64_t sample) {
  // a fade ends when the intensity is the path's
  if (f.state == State::Following && !f.jumped && d.intensity >= d.wanted) f.in_fade = false;
  stats.faded += f.in_fade ? 1 : 0;

  // the path's drawn length, once round
  if (f.state == State::Following && !f.in_fade && f.motion.on_path() && f.to_draw > 0) {
    --f.to_draw;
    exchange.log.draw(f.entry, f.motion.length() / static_cast<double>(f.motion.lap_samples()),
                      sample);
  }

  // the largest step while audible
  FocusSample now;
  now.p_D = f.motion.position().cast<float>();
  now.intensity = static_cast<float>(d.intensity);
  longest_step.look(f.last, now);
  f.last = now;
}

/// Emits one sample of every focal point.
void PathEmitter::Impl::emit(std::int64_t sample, std::span<FocusSample> out) {
  // silent stall
  if (fed && ++since_plan > stall_samples) {
    fed = false;
    const bool sounding = std::any_of(foci().begin(), foci().end(),
                                      [](const Focus& f) { return f.state != State::Resting; });
    stats.stalls += sounding ? 1 : 0;
    release();
  }

  // wanted intensities, then the limits
  wind();
  for (std::size_t i = 0; i < out.size(); ++i) move(focus[i], drive[i], sample);
  const std::span<Drive> drives(drive.data(), out.size());
  const bool limited = limit_drives(drives, fade_slew, settings.power_limit);

  for (std::size_t i = 0; i < out.size(); ++i) {
    stats.limited += limited && drive[i].wanted > 0.0 ? 1 : 0;
    count(focus[i], drive[i], sample);
    out[i] = focus[i].last;
  }
  clock.tick();
}

PathEmitter::PathEmitter(const EmitSettings& settings, double sample_rate, double max_speed)
    : Emitter(settings, sample_rate, Method::ProStm),
      impl_(std::make_unique<Impl>(exchange(), sample_rate, max_speed)) {}

PathEmitter::~PathEmitter() = default;

void PathEmitter::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  exchange().fill(*impl_, first, out);
}

}  // namespace prostm
