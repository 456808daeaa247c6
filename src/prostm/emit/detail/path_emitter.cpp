#include "prostm/emit/detail/path_emitter.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <cstddef>

#include "prostm/emit/detail/exchange.hpp"
#include "prostm/emit/detail/focus_motion.hpp"
#include "prostm/emit/detail/matching.hpp"
#include "prostm/emit/detail/start_place.hpp"
#include "prostm/emit/drive.hpp"

namespace prostm {
namespace {

constexpr double kFloatMargin = 0.999;  // keeps steps in bounds when positions become floats
constexpr double kLongestLap = 1.0;     // a new plan waits for a lap up to this long [s]

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
  bool in_fade = false;   // until the intensity is as its path wants
  bool jumped = false;    // whether it jumped in this sample
  TakeOverLog::Entry entry = TakeOverLog::kNone;
  std::int64_t to_draw = 0;  // samples of the path not drawn yet
  FocusSample last;
};

}  // namespace

struct PathEmitter::Impl {
  Impl(Exchange& e, double sample_rate, double max_speed);

  Exchange& exchange;

  // constant
  const EmitSettings& settings;
  const bool at_once;  // switch_at = "now"
  const double fade_slew, stall_slew;
  const std::int64_t stall_samples, longest_lap;

  // device's thread
  std::array<Focus, kMaxPaths> focus;
  std::array<Drive, kMaxPaths> drive;
  EmitStats stats;
  LongestStep longest_step;
  bool fed = false;             // a plan came and was not lost since
  std::int64_t since_plan = 0;  // samples

  std::span<Focus> foci() { return {focus.data(), static_cast<std::size_t>(settings.foci)}; }
  const LiftedPlan& plan() const { return exchange.inbox.value().plan; }

  /// Whether it goes over to a new plan only at the end of its lap.
  bool waits(const Focus& f) const { return !at_once && f.motion.lap_samples() <= longest_lap; }

  void receive(std::int64_t sample);
  void assign(std::int64_t sample);
  double cost(const Focus& f, const LiftedPath& path) const;
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

PathEmitter::Impl::Impl(Exchange& e, double sample_rate, double max_speed)
    : exchange(e),
      settings(e.settings),
      at_once(settings.switch_at == SwitchAt::Now),
      fade_slew(largest_slew(settings.fade_time, sample_rate)),
      stall_slew(largest_slew(settings.stall_fade_time, sample_rate)),
      stall_samples(static_cast<std::int64_t>(std::ceil(settings.stall_time * sample_rate))),
      longest_lap(static_cast<std::int64_t>(kLongestLap * sample_rate)) {
  for (Focus& f : focus) {
    f.motion.configure(sample_rate, max_speed / sample_rate * kFloatMargin);
    f.last.p_D = f.motion.position().cast<float>();
  }
}

/// Acts on the newest message, if one came.
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
  assign(sample);

  // a focal point that fades already, or need not wait, goes over at once if it can
  for (std::size_t i = 0; i < foci().size(); ++i) {
    Focus& f = focus[i];
    if (f.state == State::Leaving) {
      drive[i].max_fall = fade_slew;
      if (f.next != kNoPath) join(f, sample);
    } else if (f.state == State::Following && !waits(f)) {
      cut_lap(f);
      take_over(f, drive[i], sample);
    }
  }
}

/// Cost of a take-over in (E5) [m]: the way to go, or a substitute for a fade.
double PathEmitter::Impl::cost(const Focus& f, const LiftedPath& path) const {
  constexpr double kFadeUp = FocusMotion::kMaxOffset, kFadeBoth = 2.0 * kFadeUp;
  if (f.state == State::Resting) return kFadeUp;
  const bool at_lap_end = f.state == State::Following && waits(f);
  const PathPlace place =
      nearest_place(path, at_lap_end ? f.motion.lap_end() : f.motion.position());
  return f.motion.reaches(path, place) ? place.distance : kFadeBoth;
}

/// Gives each focal point its part in the newest plan.
void PathEmitter::Impl::assign(std::int64_t sample) {
  const std::size_t paths = std::min(plan().paths.size(), foci().size());
  stats.dropped_paths += static_cast<std::int64_t>(plan().paths.size() - paths);

  MatchCosts costs{};
  double total_length = 0.0;
  for (std::size_t p = 0; p < paths; ++p) total_length += plan().paths[p].length;
  for (std::size_t i = 0; i < foci().size(); ++i) {
    for (std::size_t p = 0; p < paths; ++p) costs[i][p] = cost(focus[i], plan().paths[p]);
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

/// Goes over to the next path by moving; false if that is too far. @pre next is a path.
bool PathEmitter::Impl::join(Focus& f, std::int64_t sample) {
  const LiftedPath& path = plan().paths[static_cast<std::size_t>(f.next)];
  const PathPlace place = nearest_place(path, f.motion.position());
  if (!f.motion.reaches(path, place)) return false;
  f.motion.join(path, place);
  adopt(f, sample);
  return true;
}

/// Returns where a silent focal point begins a path: at its first point, as planned, unless others
/// run already; then where it keeps away from them.
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

/// Goes over to the next path, or to rest, in silence.
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
  f.motion.jump(path, start_place(f, path));
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

/// Starts to go over to the next path or to rest: by moving if the path is near, else by fading.
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
  if (f.state == State::Following && f.motion.lap_ended()) {
    if (f.has_next) {
      take_over(f, d, sample);
    } else if (!f.motion.at_rest()) {
      ++stats.laps_started;
    }
  }

  // if silent, on to the next path; this sample stays silent, so that nobody feels the jump
  if (f.state != State::Following && d.intensity <= 0.0) {
    if (f.has_next) jump(f, sample);
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

  // the largest step while it sounds
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
  for (std::size_t i = 0; i < out.size(); ++i) move(focus[i], drive[i], sample);
  const std::span<Drive> drives(drive.data(), out.size());
  const bool limited = limit_drives(drives, fade_slew, settings.power_limit);

  for (std::size_t i = 0; i < out.size(); ++i) {
    stats.limited += limited && drive[i].wanted > 0.0 ? 1 : 0;
    count(focus[i], drive[i], sample);
    out[i] = focus[i].last;
  }
}

PathEmitter::PathEmitter(const EmitSettings& settings, double sample_rate, double max_speed)
    : Emitter(settings, sample_rate, Method::ProStm),
      impl_(std::make_unique<Impl>(exchange(), sample_rate, max_speed)) {}

PathEmitter::~PathEmitter() = default;

void PathEmitter::fill(std::int64_t first, std::span<FocusSample> out) noexcept {
  exchange().fill(*impl_, first, out);
}

}  // namespace prostm
