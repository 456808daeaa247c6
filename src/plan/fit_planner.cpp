#include "plan/fit_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "plan/lifted_plan.hpp"
#include "plan/pressure_raster.hpp"
#include "plan/validity.hpp"

namespace prostm::planning {
namespace {

constexpr double kSpacingShare = 0.9;  // of σ: what valid paths keep
constexpr double kAlongShare = 2.0;    // of σ: nearer along the path, spacing is not asked for
constexpr double kRounding = 1e-4;     // share of a bound that single precision may cost
constexpr double kFastWidth = 6.0;     // of the cells of preset fast [mm]
constexpr int kFastEvaluations = 2, kFastWarmEvaluations = 4;
constexpr int kFastRegionPasses = 3, kFastStopPasses = 2;
constexpr int kMendRounds = 8;      // at most, on uneven skin
constexpr double kMendStep = 2e-3;  // share of its bound that a path gives up more in each round
constexpr int kMostHalvings = 60;   // of a circle, until it is short enough on any skin

SearchSettings search_settings(const PlanSettings& s, Preset preset) {
  SearchSettings search;
  search.samples = preset == Preset::Best ? s.fit_samples : s.samples;
  search.weak = s.weak_pressure;
  search.seed = static_cast<std::uint64_t>(s.seed);
  search.hysteresis = s.fit_hysteresis;
  if (preset == Preset::Fast) {
    search.starts = 1;
    search.kicks = search.warm_starts = 0;
    search.start_evaluations = kFastEvaluations;
    search.warm_evaluations = kFastWarmEvaluations;
    search.final_evaluations = 0;
    search.region_passes = kFastRegionPasses;
    search.stop_passes = kFastStopPasses;
    search.coarse_width = search.fine_width = kFastWidth;
    return search;
  }
  search.starts = s.fit_starts;
  search.kicks = s.fit_kicks;
  return search;
}

/// Whether each number has the bits of the one before; much faster than to compare the numbers.
bool is_constant(const std::vector<double>& values) {
  return values.size() < 2 ||
         std::memcmp(values.data(), values.data() + 1, (values.size() - 1) * sizeof(double)) == 0;
}

}  // namespace

FitSettings fit_settings(const PlanSettings& s) {
  FitSettings fit;
  fit.reconstruction.sigma = static_cast<float>(kMmPerMetre * s.sigma);
  fit.reconstruction.weight_coverage = static_cast<float>(s.fit_coverage);
  fit.shape.weight_length = static_cast<float>(s.fit_length);
  fit.shape.weight_spacing = static_cast<float>(s.fit_spacing);
  fit.shape.weight_bending = static_cast<float>(s.fit_bending);
  fit.shape.spacing = static_cast<float>(kMmPerMetre * s.sigma);
  fit.shape.least_length =
      static_cast<float>(kMmPerMetre * std::min(s.least_length, s.max_length()));
  fit.shape.most_length.fill(static_cast<float>(kMmPerMetre * s.max_length()));
  return fit;
}

FitPlanner::FitPlanner(const PlanSettings& settings, Preset preset, std::size_t max_cells)
    : settings_(settings),
      search_(max_cells, fit_settings(settings), search_settings(settings, preset)) {}

/// Brings the paths of fit_ to the coordinates of a target with this origin.
void FitPlanner::move_to(const Vec2& origin) {
  const Vec2 shift = kMmPerMetre * (origin_ - origin);
  for (std::size_t i = 0; i < fit_.loops.nodes(); ++i) {
    fit_.loops.x[i] += static_cast<float>(shift.x());
    fit_.loops.y[i] += static_cast<float>(shift.y());
  }
  phases_.move(shift);
  origin_ = origin;
}

/// Length on the skin over length in the plane. @param loop one path, as in fit_.
double FitPlanner::skin_factor(const TargetField& target, std::span<const Vec2> loop) {
  if (is_flat_) return 1.0;
  flat_.points.clear();
  flat_.pressure.assign(loop.size(), 0.0);
  for (const Vec2& x : loop) flat_.points.push_back(target.origin + x / kMmPerMetre);
  const double flat = closed_length(flat_);
  return flat > 0.0 ? std::max(skin_length(flat_, target) / flat, 1.0) : 1.0;
}

/// Copies path k of fit_ to place `to` of points_.
std::span<Vec2> FitPlanner::copy_path(int k, int to) {
  const std::span<Vec2> loop = path_at(to);
  for (int i = 0; i < fit_.loops.samples; ++i) {
    loop[static_cast<std::size_t>(i)] = fit_.loops.point(i, k);
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

/// Bounds each path of points_ by the length in the plane at which it is as long on the skin as it
/// may be, if its slopes stay as they are. @param share of that length to aim at.
/// @return whether any path is too long.
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

/// Leaves out the paths of points_ that are too long on the skin; where all are, the first becomes
/// a circle that is not. @return how many are left.
int FitPlanner::leave_out_long(const TargetField& target, int paths, double least_length) {
  const auto is_long = [&](std::span<const Vec2> loop) {
    return loop_length(loop) * skin_factor(target, loop) > kMmPerMetre * settings_.max_length();
  };
  int kept = 0;
  for (int k = 0; k < paths; ++k) {
    if (is_long(path_at(k))) continue;
    std::copy_n(path_at(k).begin(), fit_.loops.samples, path_at(kept).begin());
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

/// Mends length on the skin, spacing and crossings; then pressures are solved again.
void FitPlanner::mend(const TargetField& target, PlanStats& stats) {
  const double sigma = kMmPerMetre * settings_.sigma;
  SpacingRule rule;
  rule.spacing = (1.0 + kRounding) * kSpacingShare * sigma;
  rule.along = (1.0 - kRounding) * kAlongShare * sigma;
  rule.least_length = kMmPerMetre * std::min(settings_.least_length, settings_.max_length());

  const int n = fit_.loops.samples;
  int paths = 0;
  for (const int k : by_pressure()) copy_path(k, paths++);
  // a path that is mended lies on other slopes than before, so its bound is another
  bool any_long = bound_lengths(target, paths, 1.0 - kRounding, rule);
  for (int round = 1; round == 1 || (any_long && round <= kMendRounds); ++round) {
    const auto size = static_cast<std::size_t>(paths * n);
    paths = make_spaced(std::span<Vec2>(points_.data(), size), n, rule, spacing_);
    any_long = bound_lengths(target, paths, 1.0 - round * kMendStep, rule);
  }
  if (any_long) paths = leave_out_long(target, paths, rule.least_length);

  fit_.loops.reset(n, paths);
  for (int k = 0; k < paths; ++k) {
    for (int i = 0; i < n; ++i) fit_.loops.set_point(i, k, path_at(k)[static_cast<std::size_t>(i)]);
  }
  search_.solve(fit_);
  ++stats.cost_evaluations;
}

void FitPlanner::append(const TargetField& target, double maximum, int patch, Plan& plan,
                        PlanStats& stats) {
  const int n = fit_.loops.samples, paths = fit_.loops.paths;
  std::array<double, kMaxPaths> factor{}, period{};
  for (int k = 0; k < paths; ++k) {
    const std::span<const Vec2> loop = copy_path(k, 0);
    const auto place = static_cast<std::size_t>(k);
    factor[place] = skin_factor(target, loop);
    period[place] = loop_length(loop) / kMmPerMetre * factor[place] / settings_.speed;
  }
  const LapStarts starts = phases_.choose(fit_.loops, period);

  for (int k = 0; k < paths; ++k) {
    const auto place = static_cast<std::size_t>(k);
    FocalPath path;
    path.patch = patch;
    for (int i = 0; i < n; ++i) {
      path.points.push_back(target.origin +
                            fit_.loops.point(starts[place].sample(i, n), k) / kMmPerMetre);
    }
    path.length = closed_length(path);
    path.speed = settings_.speed;
    path.period = path.length * factor[place] / path.speed;
    const double gain = settings_.gain_law().of(path.period);
    for (int i = 0; i < n; ++i) {
      const std::size_t node = fit_.loops.node(starts[place].sample(i, n), k);
      path.pressure.push_back(gain * maximum *
                              static_cast<double>(fit_.reconstruction.pressure[node]));
    }
    plan.paths.push_back(path);
  }
  stats.leaves += paths;
}

void FitPlanner::plan_patch(const TargetField& target, double maximum, int patch, int paths,
                            double budget, Plan& plan, PlanStats& stats) {
  StageTimer timer;
  is_flat_ = is_constant(target.height);
  if (!settings_.widths.empty()) {
    settings_.sigma = settings_.widths.on(target);
    search_.set_sigma(kMmPerMetre * settings_.sigma);
  }
  search_.set_target(target, maximum, budget);
  stats.init += timer.lap();

  move_to(target.origin);
  const bool continues = has_previous_ && fit_.loops.paths <= paths;
  if (!continues) phases_.forget();
  stats.cost_evaluations += search_.run(paths, continues, fit_);
  std::array<float, kMaxPaths> most{};
  for (int k = 0; k < fit_.loops.paths; ++k) {
    most[static_cast<std::size_t>(k)] = static_cast<float>(kMmPerMetre * settings_.max_length() /
                                                           skin_factor(target, copy_path(k, 0)));
  }
  stats.cost_evaluations += search_.finish(most, fit_);
  stats.cost += static_cast<double>(fit_.cost);

  const double start = timer.seconds();
  mend(target, stats);
  append(target, maximum, patch, plan, stats);
  search_.learn_ending(timer.seconds() - start);
  has_previous_ = true;
  stats.refine += timer.lap();
}

}  // namespace prostm::planning
