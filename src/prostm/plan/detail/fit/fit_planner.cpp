#include "prostm/plan/detail/fit/fit_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "prostm/plan/detail/fit/fit_settings.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"
#include "prostm/plan/detail/validity.hpp"
#include "prostm/plan/lifted_plan.hpp"

namespace prostm::planning {
namespace {

constexpr double kSpacingShare = 0.9;  // spacing that valid paths keep, over σ
constexpr double kAlongShare = 2.0;    // over σ: samples nearer along a path may be closer
constexpr double kRounding = 1e-4;     // relative margin of bounds for single-precision rounding
constexpr int kMendRounds = 8;         // maximum number of rounds, on uneven skin
constexpr double kMendStep = 2e-3;     // relative reduction of a too long path's bound per round
constexpr int kMostHalvings = 60;      // halvings that make a circle short enough on any skin
// Bound of the ratios of full output to pressure and of pressure to full output, so that single
// precision resolves both. Higher output counts as unlimited; higher pressure is clamped.
constexpr double kAmple = 1e4;
constexpr int kMoveRounds = 4;         // rounds of moving points and mending paths
constexpr float kMovedBending = 0.1F;  // factor on the weight of (P15) while points move

/// Returns whether all values have the same bits; much faster than comparing them as numbers.
bool is_constant(const std::vector<double>& values) {
  return values.size() < 2 ||
         std::memcmp(values.data(), values.data() + 1, (values.size() - 1) * sizeof(double)) == 0;
}

}  // namespace

FitPlanner::FitPlanner(const PlanSettings& settings, std::size_t max_cells,
                       const FeltTuning& tuning)
    : settings_(settings),
      search_(max_cells, fit_settings(settings), search_settings(settings)),
      felt_(settings.felt_weight > 0.0 ? std::make_unique<FeltStep>(settings, tuning) : nullptr),
      in_step_(felt_ || settings.traits().chooses_by_percept),
      pieces_(pieces_of(settings)) {}

/// Bounds of (P18) for a path whose rendered pressure is `gain` times the effective one.
/// @param speed of its focal point [m/s].
PlayBounds FitPlanner::play_bounds(double gain, double speed) const {
  // full output over the target's maximum
  const double highest = gain * rendered_;
  const double room = full_scale_ >= kAmple * highest ? kAmple : full_scale_ / highest;
  // length of a full rise [mm]
  const double reach = kMmPerMetre * speed * settings_.rise_time;
  return PlayBounds::all(static_cast<float>(std::min(1.0, room)),
                         static_cast<float>(std::sqrt(room) / reach),
                         static_cast<float>(settings_.silent_below * room));
}

/// Transforms the paths of fit_ to the coordinates of a target with this origin.
void FitPlanner::move_to(const Vec2& origin) {
  const Vec2 shift = kMmPerMetre * (origin_ - origin);
  for (std::size_t i = 0; i < fit_.loops.nodes(); ++i) {
    fit_.loops.x[i] += static_cast<float>(shift.x());
    fit_.loops.y[i] += static_cast<float>(shift.y());
  }
  phases_.move(shift);
  if (felt_) felt_->move(shift);
  origin_ = origin;
}

/// Ratio of the length on the skin to that in the plane. @param loop one path, as in fit_.
double FitPlanner::skin_factor(const TargetField& target, std::span<const Vec2> loop) {
  if (is_flat_) return 1.0;
  flat_.points.clear();
  flat_.pressure.assign(loop.size(), 0.0);
  for (const Vec2& x : loop) flat_.points.push_back(target.origin + x / kMmPerMetre);
  const double flat = closed_length(flat_);
  return flat > 0.0 ? std::max(skin_length(flat_, target) / flat, 1.0) : 1.0;
}

/// Copies path k of fit_ to place `to` of points_, cutting each segment into pieces so that the
/// path has samples_ points.
std::span<Vec2> FitPlanner::copy_path(int k, int to) {
  const std::span<Vec2> loop = path_at(to);
  const int pieces = samples_ / fit_.loops.samples;
  for (int i = 0; i < samples_; ++i) {
    const int first = i / pieces, second = (first + 1) % fit_.loops.samples;
    const double along = static_cast<double>(i % pieces) / pieces;
    loop[static_cast<std::size_t>(i)] =
        (1.0 - along) * fit_.loops.point(first, k) + along * fit_.loops.point(second, k);
  }
  return loop;
}

/// The paths of fit_, those with the most pressure first.
boost::container::static_vector<int, kMaxPaths> FitPlanner::by_pressure() const {
  boost::container::static_vector<int, kMaxPaths> order;
  std::array<float, kMaxPaths> sum{};
  for (int k = 0; k < fit_.loops.paths; ++k) {
    float& own = sum[static_cast<std::size_t>(k)];
    for (int i = 0; i < fit_.loops.samples; ++i) {
      own += fit_.reconstruction.pressure[fit_.loops.node(i, k)];
    }
    const auto place = std::find_if(order.begin(), order.end(), [&](int other) {
      return own > sum[static_cast<std::size_t>(other)];
    });
    order.insert(place, k);
  }
  return order;
}

/// Sets the bound of each path of points_: the length in the plane at which it reaches its maximum
/// length on the skin, provided that its slopes do not change.
/// @param share factor on the bound of a path that is too long. @return whether any path is too
/// long.
bool FitPlanner::bound_lengths(const TargetField& target, int paths, double share,
                               SpacingRule& rule) {
  bool any = false;
  for (int k = 0; k < paths; ++k) {
    const std::span<const Vec2> loop = path_at(k);
    const double most = kMmPerMetre * settings_.max_length() / skin_factor(target, loop);
    const bool is_long = loop_length(loop) > most;
    any = any || is_long;
    rule.most_length[static_cast<std::size_t>(k)] = (is_long ? share : 1.0 - kRounding) * most;
  }
  return any;
}

/// Drops the paths of points_ that are too long on the skin; if all are, the first becomes a
/// circle that is short enough. @return the number of paths left.
int FitPlanner::drop_long(const TargetField& target, int paths, double least_length) {
  const auto is_long = [&](std::span<const Vec2> loop) {
    return loop_length(loop) * skin_factor(target, loop) > kMmPerMetre * settings_.max_length();
  };
  int kept = 0;
  for (int k = 0; k < paths; ++k) {
    if (is_long(path_at(k))) continue;
    std::copy_n(path_at(k).begin(), samples_, path_at(kept).begin());
    ++kept;
  }
  if (kept > 0) return kept;
  const std::span<Vec2> loop = path_at(0);
  const Vec2 centre = centroid(loop);
  for (int halving = 0; halving < kMostHalvings; ++halving, least_length *= 0.5) {
    make_circle(loop, centre, least_length);
    if (!is_long(loop)) break;
  }
  return 1;
}

/// Returns the rule that valid paths keep. @param between distance from a sample to the midpoint of
/// its segment, where a further sample will be added; 0: none will [mm].
SpacingRule FitPlanner::spacing_rule(double between) const {
  const double sigma = kMmPerMetre * settings_.sigma;
  SpacingRule rule;
  rule.spacing = std::hypot((1.0 + kRounding) * kSpacingShare * sigma, between);
  rule.along = (1.0 - kRounding) * kAlongShare * sigma;
  rule.least_length = kMmPerMetre * std::min(settings_.least_length, settings_.max_length());
  return rule;
}

/// Makes the paths of points_ keep the rule and their maximum length on the skin. @return the
/// number of paths kept.
int FitPlanner::space_out(const TargetField& target, int paths, SpacingRule rule) {
  // mending moves a path to other slopes of the skin, so its bound changes
  bool any_long = bound_lengths(target, paths, 1.0 - kRounding, rule);
  for (int round = 1; round == 1 || (any_long && round <= kMendRounds); ++round) {
    paths = make_spaced(points_of(paths), samples_, rule, spacing_);
    any_long = bound_lengths(target, paths, 1.0 - round * kMendStep, rule);
  }
  return any_long ? drop_long(target, paths, rule.least_length) : paths;
}

/// Copies the paths of points_ to fit_.
void FitPlanner::take_points(int paths) {
  const int pieces = samples_ / fit_.loops.samples;
  fit_.loops.reset(fit_.loops.samples, paths);
  for (int k = 0; k < paths; ++k) {
    for (int i = 0; i < fit_.loops.samples; ++i)
      fit_.loops.set_point(i, k, path_at(k)[static_cast<std::size_t>(i * pieces)]);
  }
}

/// Mends length on the skin, spacing and crossings; then solves the pressures and makes them
/// playable.
void FitPlanner::mend(const TargetField& target, PlanStats& stats) {
  // first the samples of the search: they are fewer, and so easier to move
  int paths = 0;
  samples_ = fit_.loops.samples;
  for (const int k : by_pressure()) copy_path(k, paths++);
  const double segment = kMmPerMetre * settings_.max_length() / samples_;
  paths = space_out(target, paths, spacing_rule(pieces_ > 1 ? 0.5 * segment : 0.0));
  take_points(paths);
  if (pieces_ > 1) paths = mend_between(target, paths);
  solve(target, paths, stats);
  make_playable(plan_.loops, bounds_, plan_.reconstruction.pressure);
}

/// Mends the samples of the plan, most of which are already valid. @return the number of paths
/// kept.
int FitPlanner::mend_between(const TargetField& target, int paths) {
  samples_ *= pieces_;
  for (int k = 0; k < paths; ++k) copy_path(k, k);
  SpacingRule rule = spacing_rule(0.0);
  // with more samples, paths follow more of the skin's slopes and become longer
  const bool any_long = bound_lengths(target, paths, 1.0 - kRounding, rule);
  if (!any_long && are_apart(points_of(paths), samples_, rule, spacing_)) return paths;
  paths = space_out(target, paths, rule);
  take_points(paths);
  return paths;
}

/// Copies the paths of points_ to plan_, and sets bounds_ to the limits of the emission on them.
void FitPlanner::take_plan(const TargetField& target, int paths) {
  plan_.loops.reset(samples_, paths);
  bounds_ = play_bounds(settings_.gain, settings_.path_speed());
  for (int k = 0; k < paths; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const std::span<Vec2> loop = path_at(k);
    for (int i = 0; i < samples_; ++i) {
      Vec2& x = loop[static_cast<std::size_t>(i)];
      plan_.loops.set_point(i, k, x);
      x = plan_.loops.point(i, k);  // the same rounding as in the plan
    }
    factor_[place] = skin_factor(target, loop);
    length_[place] = loop_length(loop) / kMmPerMetre * factor_[place];
    period_[place] = length_[place] / settings_.path_speed();
  }
  if (in_step_) step_together(paths);
  for (int k = 0; k < paths; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const double period = period_[place];
    const PlayBounds own = play_bounds(settings_.gain_law().of(period), length_[place] / period);
    bounds_.most[place] = own.most[place];
    bounds_.slope[place] = own.slope[place];
    bounds_.least[place] = own.least[place];
  }
}

/// Slows the paths down so that each makes a whole number of laps in a common loop.
void FitPlanner::step_together(int paths) {
  const auto own = std::span<const double>(period_).first(static_cast<std::size_t>(paths));
  const double longest = 1.0 / settings_.draw_rate;
  loop_ = is_alone_ ? choose_loop(own, longest, last_period_) : loop_of(own, longest);
  for (int k = 0; k < paths; ++k) {
    const auto place = static_cast<std::size_t>(k);
    // rounding to single precision may make a path slightly longer than allowed
    loop_.laps[place] = std::max(loop_.laps[place], 1);
    period_[place] = loop_.period / loop_.laps[place];
  }
}

/// Solves the pressures of the paths of points_, nearly within the limits of the emission, and
/// drops silent paths.
void FitPlanner::solve(const TargetField& target, int& paths, PlanStats& stats) {
  for (;;) {
    take_plan(target, paths);
    ++stats.cost_evaluations;
    search_.solve(bounds_, plan_);
    if (!drop_silent(paths)) return;
    take_points(paths);
  }
}

/// Drops the weakest of several paths of points_ if its pressure is weak everywhere, or if it is
/// silent while another path is not. @return whether a path was dropped.
bool FitPlanner::drop_silent(int& paths) {
  std::array<float, kMaxPaths> highest{};
  for (int k = 0; k < paths; ++k) {
    float& own = highest[static_cast<std::size_t>(k)];
    for (int i = 0; i < samples_; ++i)
      own = std::max(own, plan_.reconstruction.pressure[plan_.loops.node(i, k)]);
  }
  const auto [least, most] = std::minmax_element(highest.begin(), highest.begin() + paths);
  const float not_silent = play_bounds(settings_.gain, settings_.path_speed()).least[0];
  const auto weak = static_cast<float>(settings_.weak_pressure);
  if (paths == 1 || *least >= (*most >= not_silent ? std::max(weak, not_silent) : weak))
    return false;
  const auto silent = static_cast<int>(least - highest.begin());
  --paths;
  std::copy(path_at(silent).end(), path_at(paths).end(), path_at(silent).begin());
  return true;
}

/// Chooses the starts of the laps of plan_, (P16).
void FitPlanner::choose_starts() {
  starts_ = phases_.choose(fit_.loops, std::span<const double>(period_).first(
                                           static_cast<std::size_t>(plan_.loops.paths)));
  for (LapStart& start : starts_) start.first *= pieces_;
}

/// Returns the shape settings of the paths of fit_ on this skin.
ShapeSettings FitPlanner::shape_of(const TargetField& target) {
  ShapeSettings shape = fit_settings(settings_).shape;
  samples_ = fit_.loops.samples;
  for (int k = 0; k < fit_.loops.paths; ++k) {
    shape.most_length[static_cast<std::size_t>(k)] = static_cast<float>(
        kMmPerMetre * settings_.max_length() / skin_factor(target, copy_path(k, 0)));
  }
  return shape;
}

void FitPlanner::move_felt(const PatchTask& task, FeltStep& step, int rounds, PlanStats& stats) {
  for (int round = 0; round < rounds; ++round) {
    LapStarts starts = starts_;
    for (LapStart& start : starts) start.first /= pieces_;
    for (int k = 0; k < fit_.loops.paths; ++k) {
      for (int i = 0; i < fit_.loops.samples; ++i) {
        fit_.reconstruction.pressure[fit_.loops.node(i, k)] =
            plan_.reconstruction.pressure[plan_.loops.node(i * pieces_, k)];
      }
    }
    ShapeSettings shape = shape_of(task.target);
    shape.weight_bending *= kMovedBending;
    stats.cost_evaluations += step.move_points(starts, loop_, shape, bounds_, pieces_,
                                               fit_.reconstruction.pressure, fit_.loops);
    mend(task.target, stats);
    choose_starts();
  }
}

void FitPlanner::choose_felt(FeltStep& step, PlanStats& stats) {
  stats.cost_evaluations +=
      step.choose_pressures(plan_.loops, starts_, loop_, settings_.felt_points ? 1 : pieces_,
                            bounds_, plan_.reconstruction.pressure);
  make_playable(plan_.loops, bounds_, plan_.reconstruction.pressure);
}

void FitPlanner::append(const PatchTask& task, Plan& plan, PlanStats& stats) {
  const int n = samples_, paths = plan_.loops.paths;
  for (int k = 0; k < paths; ++k) {
    const auto place = static_cast<std::size_t>(k);
    const LapStart start = starts_[place];
    FocalPath path;
    path.patch = task.patch;
    for (int i = 0; i < n; ++i) {
      path.points.push_back(task.target.origin +
                            plan_.loops.point(start.sample(i, n), k) / kMmPerMetre);
    }
    path.length = closed_length(path);
    const double on_skin = path.length * factor_[place];
    path.period = in_step_ ? period_[place] : on_skin / settings_.path_speed();
    path.speed = in_step_ ? on_skin / path.period : settings_.path_speed();
    const double gain = settings_.gain_law().of(path.period);
    for (int i = 0; i < n; ++i) {
      const std::size_t node = plan_.loops.node(start.sample(i, n), k);
      path.pressure.push_back(gain * rendered_ *
                              static_cast<double>(plan_.reconstruction.pressure[node]));
    }
    plan.paths.push_back(path);
  }
  plan.loop = in_step_ ? loop_.period : 0.0;
  last_period_ = plan.loop;
  stats.cost += static_cast<double>(fit_.cost);
  stats.leaves += paths;
}

/// Sets the target, and transforms the paths of the last plan to its coordinates.
void FitPlanner::set_target(const PatchTask& task, PlanStats& stats) {
  const StageTimer timer;
  const TargetField& target = task.target;
  full_scale_ = task.full_scale;
  is_alone_ = task.is_alone;
  rendered_ = std::min(task.maximum, kAmple * (full_scale_ / settings_.gain));
  search_.set_bounds(play_bounds(settings_.gain, settings_.path_speed()));
  is_flat_ = is_constant(target.height);
  if (!settings_.widths.empty()) {
    settings_.sigma = settings_.widths.on(target);
    search_.set_sigma(kMmPerMetre * settings_.sigma);
  }
  search_.set_target(target, task.maximum, task.budget);
  move_to(target.origin);
  stats.init += timer.seconds();
}

/// Makes the paths of the search valid. @param timer since the search began.
void FitPlanner::finish(const PatchTask& task, const StageTimer& timer, PlanStats& stats) {
  stats.cost_evaluations += search_.finish(shape_of(task.target).most_length, fit_);
  ending_.restart();
  mend(task.target, stats);
  choose_starts();
  has_previous_ = true;
  stats.refine += timer.seconds();
}

void FitPlanner::find(const PatchTask& task, PlanStats& stats) {
  set_target(task, stats);
  const StageTimer timer;
  const bool continues = has_previous_ && fit_.loops.paths <= task.paths;
  if (!continues) {
    phases_.forget();
    if (felt_) felt_->forget();
    last_period_ = 0.0;
  }
  stats.cost_evaluations += search_.run(task.paths, continues, fit_);
  finish(task, timer, stats);
}

void FitPlanner::find_from(const Loops& loops, const PatchTask& task, PlanStats& stats) {
  reset();
  phases_.forget();
  set_target(task, stats);
  fit_.loops = loops;
  const StageTimer timer;
  stats.cost_evaluations += search_.follow(fit_);
  finish(task, timer, stats);
}

void FitPlanner::plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) {
  find(task, stats);
  StageTimer timer;
  if (felt_) {
    felt_->set_target(task.target, task.maximum, settings_.sigma);
    if (settings_.felt_points) move_felt(task, *felt_, kMoveRounds, stats);
    choose_felt(*felt_, stats);
  }
  append(task, plan, stats);
  search_.learn_ending(ending_.seconds());
  stats.refine += timer.lap();
}

}  // namespace prostm::planning
