#include "plan/fit_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "plan/lifted_plan.hpp"
#include "plan/pressure_raster.hpp"
#include "plan/validity.hpp"

namespace prostm::planning {
namespace {

constexpr double kSpacingShare = 0.9;  // of σ: what valid paths keep
constexpr double kAlongShare = 2.0;    // of σ: nearer along the path, spacing is not asked for
constexpr double kRounding = 1e-4;     // share of a bound that single precision may cost
constexpr double kFastWidth = 6.0;     // of the cells of preset fast [mm]
constexpr int kFastEvaluations = 9, kFastWarmEvaluations = 5;
constexpr double kUneven = 1e-6;  // a skin that lengthens paths by less is flat
constexpr int kMendRounds = 3;    // on uneven skin

FitSettings fit_settings(const PlanSettings& s) {
  FitSettings fit;
  fit.reconstruction.sigma = static_cast<float>(kMmPerMetre * s.sigma);
  fit.reconstruction.weight_coverage = static_cast<float>(s.fit_coverage);
  fit.shape.weight_length = static_cast<float>(s.weight_length);
  fit.shape.weight_spacing = static_cast<float>(s.weight_intersection);
  fit.shape.weight_bending = static_cast<float>(s.fit_bending);
  fit.shape.spacing = static_cast<float>(kMmPerMetre * s.sigma);
  fit.shape.least_length = static_cast<float>(kMmPerMetre * std::min(s.least_length, s.max_length));
  fit.shape.most_length.fill(static_cast<float>(kMmPerMetre * s.max_length));
  return fit;
}

SearchSettings search_settings(const PlanSettings& s, Preset preset) {
  SearchSettings search;
  search.samples = s.samples;
  search.weak = s.weak_pressure;
  search.seed = static_cast<std::uint64_t>(s.seed);
  search.hysteresis = s.fit_hysteresis;
  if (preset == Preset::Fast) {
    search.starts = 1;
    search.kicks = search.warm_starts = 0;
    search.start_evaluations = kFastEvaluations;
    search.warm_evaluations = kFastWarmEvaluations;
    search.final_evaluations = 0;
    search.coarse_width = search.fine_width = kFastWidth;
    return search;
  }
  search.starts = s.fit_starts;
  search.kicks = s.fit_kicks;
  return search;
}

}  // namespace

FitPlanner::FitPlanner(const PlanSettings& settings, Preset preset, std::size_t max_cells)
    : settings_(settings),
      search_(max_cells, fit_settings(settings), search_settings(settings, preset)) {}

/// The last plan's loops in the coordinates of this target; null when there are none to use.
const Loops* FitPlanner::previous_loops(const TargetField& target, int paths) {
  if (!has_previous_ || previous_.paths > paths) return nullptr;
  shifted_ = previous_;
  const auto x = static_cast<float>(kMmPerMetre * target.origin.x());
  const auto y = static_cast<float>(kMmPerMetre * target.origin.y());
  for (std::size_t i = 0; i < shifted_.nodes(); ++i) {
    shifted_.x[i] -= x;
    shifted_.y[i] -= y;
  }
  return &shifted_;
}

/// Length on the skin over length in the plane.
double FitPlanner::skin_factor(const TargetField& target, int path) {
  if (is_flat_) return 1.0;
  flat_.points.clear();
  flat_.pressure.assign(static_cast<std::size_t>(fit_.loops.samples), 0.0);
  for (int i = 0; i < fit_.loops.samples; ++i) {
    flat_.points.push_back(target.origin + fit_.loops.point(i, path) / kMmPerMetre);
  }
  const double flat = closed_length(flat_);
  return flat > 0.0 ? std::max(skin_length(flat_, target) / flat, 1.0) : 1.0;
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

/// One round of mending: length on the skin, spacing and crossings; pressures are solved again.
/// @return whether the skin made any path longer than it is in the plane.
bool FitPlanner::mend(const TargetField& target, PlanStats& stats) {
  const double sigma = kMmPerMetre * settings_.sigma;
  SpacingRule rule;
  rule.spacing = (1.0 + kRounding) * kSpacingShare * sigma;
  rule.along = (1.0 - kRounding) * kAlongShare * sigma;
  rule.least_length = kMmPerMetre * std::min(settings_.least_length, settings_.max_length);

  const int n = fit_.loops.samples;
  bool uneven = false;
  std::size_t size = 0;
  for (const int k : by_pressure()) {
    const double factor = skin_factor(target, k);
    uneven = uneven || factor > 1.0 + kUneven;
    rule.most_length[size / static_cast<std::size_t>(n)] =
        (1.0 - kRounding) * kMmPerMetre * settings_.max_length / factor;
    for (int i = 0; i < n; ++i) points_[size++] = fit_.loops.point(i, k);
  }
  const int kept = make_spaced(std::span<Vec2>(points_.data(), size), n, rule);
  fit_.loops.reset(n, kept);
  for (int k = 0; k < kept; ++k) {
    for (int i = 0; i < n; ++i) {
      fit_.loops.set_point(i, k, points_[static_cast<std::size_t>(k * n + i)]);
    }
  }
  search_.solve(fit_);
  ++stats.cost_evaluations;
  return uneven;
}

void FitPlanner::append(const TargetField& target, double maximum, int patch, Plan& plan,
                        PlanStats& stats) {
  const std::size_t before = plan.paths.size();
  for (int k = 0; k < fit_.loops.paths; ++k) {
    FocalPath path;
    path.patch = patch;
    for (int i = 0; i < fit_.loops.samples; ++i) {
      path.points.push_back(target.origin + fit_.loops.point(i, k) / kMmPerMetre);
      path.pressure.push_back(
          settings_.gain * maximum *
          static_cast<double>(fit_.reconstruction.pressure[fit_.loops.node(i, k)]));
    }
    path.length = closed_length(path);
    path.speed = settings_.speed;
    path.period = path.length / path.speed;
    plan.paths.push_back(path);
  }
  stats.leaves += static_cast<int>(plan.paths.size() - before);
}

void FitPlanner::plan_patch(const TargetField& target, double maximum, int patch, int paths,
                            double budget, Plan& plan, PlanStats& stats) {
  StageTimer timer;
  is_flat_ = std::all_of(target.height.begin(), target.height.end(),
                         [&](double height) { return height == target.height.front(); });
  search_.set_target(target, maximum, budget);
  stats.init += timer.lap();

  stats.cost_evaluations += search_.run(paths, previous_loops(target, paths), fit_);
  std::array<float, kMaxPaths> most{};
  for (int k = 0; k < fit_.loops.paths; ++k) {
    most[static_cast<std::size_t>(k)] =
        static_cast<float>(kMmPerMetre * settings_.max_length / skin_factor(target, k));
  }
  stats.cost_evaluations += search_.finish(most, fit_);
  stats.cost += static_cast<double>(fit_.cost);

  // a path that is mended has another length on uneven skin
  for (int round = 0; round < kMendRounds && mend(target, stats); ++round) {
  }
  append(target, maximum, patch, plan, stats);
  previous_ = fit_.loops;
  const auto x = static_cast<float>(kMmPerMetre * target.origin.x());
  const auto y = static_cast<float>(kMmPerMetre * target.origin.y());
  for (std::size_t i = 0; i < previous_.nodes(); ++i) {
    previous_.x[i] += x;
    previous_.y[i] += y;
  }
  has_previous_ = true;
  stats.refine += timer.lap();
}

}  // namespace prostm::planning
