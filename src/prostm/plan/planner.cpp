#include "prostm/plan/planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/detail/fit/felt/felt_planner.hpp"
#include "prostm/plan/detail/fit/fit_planner.hpp"
#include "prostm/plan/detail/fit/raster/cell_weights.hpp"
#include "prostm/plan/detail/paper/refine.hpp"
#include "prostm/plan/detail/tours.hpp"
#include "prostm/plan/detail/validity.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/patches.hpp"
#include "prostm/target/pressure_share.hpp"

namespace prostm {

using namespace planning;

namespace {

constexpr double kLengthTolerance = 0.5e-3;  // tolerance of "longer than L" in the statistics [m]
constexpr double kFieldPeriod = 0.04;        // assumed time between fields that have no time [s]

/// Returns whether there is pressure of positive weight. @param maximum from highest_pressure().
bool has_counted_pressure(const TargetField& target, double maximum) {
  return maximum > 0.0 && (target.weight.empty() || CellWeights(target, maximum).any_pressure());
}

/// Returns a planner for each patch, of a fitted preset; else none.
std::vector<std::unique_ptr<PatchPlanner>> make_fits(const PlanSettings& settings,
                                                     std::size_t max_cells) {
  std::vector<std::unique_ptr<PatchPlanner>> fits;
  if (!settings.traits().is_fitted()) return fits;
  const bool felt = settings.traits().chooses_by_percept;
  const auto tables = felt ? std::make_shared<FeltTables>() : nullptr;
  for (int patch = 0; patch < kMaxPatches; ++patch) {
    if (felt) {
      fits.push_back(std::make_unique<FeltPlanner>(settings, max_cells, tables));
    } else {
      fits.push_back(std::make_unique<FitPlanner>(settings, max_cells));
    }
  }
  return fits;
}

}  // namespace

struct Planner::Scratch {
  Scratch(const PlanSettings& s, std::size_t cells)
      : settings(s),
        max_cells(cells),
        raster(cells),
        kmeans(cells),
        refiner(CostSettings(s), s.paths, s.samples, s.refine_iterations),
        fits(make_fits(s, cells)) {
    x.reserve(static_cast<std::size_t>(s.paths) * static_cast<std::size_t>(s.samples));
  }

  /// Appends the paths for one patch to `plan` and adds to `stats` (all but the total).
  /// @param task without its maximum and full scale. @param highest pressure of the frame.
  PlanStatus plan_patch(PatchTask task, double highest, Plan& plan, PlanStats& stats,
                        PlanTrace* trace);
  /// Rendered pressure at full output. @param highest pressure of the frame.
  double full_scale(double highest) const {
    return settings.full_scale_pressure > 0.0 ? settings.full_scale_pressure
                                              : settings.gain * highest;
  }
  /// Returns the time of a target without one.
  double next_time() { return fields++ * kFieldPeriod; }
  /// Whether there is anything to plan for. @param maximum the target's largest pressure.
  bool has_pressure(const TargetField& target, double maximum) const {
    return fits.empty() ? maximum > 0.0 : has_counted_pressure(target, maximum);
  }
  void collect_points(const TargetField& target, double maximum);
  void initial_paths(int paths, PlanStats& stats, StageTimer& timer, const Vec2& origin,
                     PlanTrace* trace);
  void append(const TargetField& target, int patch, double maximum, Plan& plan,
              PlanStats& stats) const;

  PlanSettings settings;
  std::size_t max_cells;
  int fields = 0;  // single fields planned
  PressureRaster raster;
  WeightedKMeans kmeans;
  Clusters clusters;
  DistanceTable distance;
  Refiner refiner;
  std::vector<std::unique_ptr<PatchPlanner>> fits;  // one for each patch, of a fitted preset
  // samples of the paths, one path after the other, heaviest first, relative to the origin [mm]
  std::vector<Vec2> x;
};

void Planner::Scratch::collect_points(const TargetField& target, double maximum) {
  raster.set(target, maximum);
  kmeans.clear();
  const double weak = pressure_share(settings.weak_pressure, 1.0);  // rounded like the cells
  const double cell = kMmPerMetre * target.cell;
  for (int row = 0; row < target.rows; ++row) {
    for (int col = 0; col < target.cols; ++col) {
      const std::size_t i = target.index(row, col);
      const double p = target.skin[i] != 0 ? pressure_share(target.pressure[i], maximum) : 0.0;
      if (p >= weak) kmeans.add(cell * Vec2(col, row), p);
    }
  }
}

/// Computes, splits and resamples the tour: fills `x`.
void Planner::Scratch::initial_paths(int paths, PlanStats& stats, StageTimer& timer,
                                     const Vec2& origin, PlanTrace* trace) {
  // one tour through all clusters
  distance.set(std::span<const Vec2>(clusters.centre.data(), clusters.centre.size()));
  Tour whole(clusters.centre.size());
  for (std::size_t c = 0; c < whole.size(); ++c) whole[c] = static_cast<std::uint8_t>(c);
  const auto seed = static_cast<std::uint64_t>(settings.seed);
  shortest_tour(distance, std::span<std::uint8_t>(whole.data(), whole.size()), seed);
  stats.tour += timer.lap();

  // split it, and keep the heaviest
  const auto leaves =
      split_tours(clusters, distance, whole, kMmPerMetre * settings.max_length(), seed);
  const std::size_t kept = std::min(leaves.size(), static_cast<std::size_t>(paths));
  stats.leaves += static_cast<int>(leaves.size());
  stats.split += timer.lap();

  // N samples each
  const auto n = static_cast<std::size_t>(settings.samples);
  x.resize(kept * n);
  for (std::size_t k = 0; k < kept; ++k) {
    resample_tour(clusters,
                  std::span<const std::uint8_t>(leaves[k].tour.data(), leaves[k].tour.size()),
                  std::span<Vec2>(x).subspan(k * n, n));
  }
  stats.resample += timer.lap();

  if (trace != nullptr) {
    *trace = {};
    for (const Vec2& c : clusters.centre) trace->clusters.push_back(origin + c / kMmPerMetre);
    trace->cluster_mass.assign(clusters.mass.begin(), clusters.mass.end());
    trace->tour.assign(whole.begin(), whole.end());
    for (std::size_t k = 0; k < kept; ++k) {
      trace->split.emplace_back(leaves[k].tour.begin(), leaves[k].tour.end());
    }
    timer.restart();
  }
}

void Planner::Scratch::append(const TargetField& target, int patch, double maximum, Plan& plan,
                              PlanStats& stats) const {
  const auto n = static_cast<std::size_t>(settings.samples);
  const std::span<const Vec2> all(x);
  for (std::size_t begin = 0; begin < all.size(); begin += n) {
    FocalPath path;
    path.patch = patch;
    const std::span<const Vec2> loop = all.subspan(begin, n);
    for (const Vec2& sample : loop) path.points.push_back(target.origin + sample / kMmPerMetre);
    path.length = closed_length(path);
    path.speed = settings.path_speed();
    path.period = skin_length(path, target) / path.speed;
    const double gain = settings.gain_law().of(path.period);
    for (const Vec2& sample : loop) {
      // a Catmull-Rom spline undershoots near steep edges; pressure cannot be negative
      path.pressure.push_back(gain * std::max(raster.sample(sample).value, 0.0) * maximum);
    }

    // violations, within the path and with earlier paths
    if (path.length > settings.max_length() + kLengthTolerance) ++stats.long_paths;
    stats.crossings += count_self_crossings(loop);
    for (std::size_t other = 0; other < begin; other += n) {
      stats.crossings += count_crossings(all.subspan(other, n), loop);
    }
    plan.paths.push_back(path);
  }
}

PlanStatus Planner::Scratch::plan_patch(PatchTask task, double highest, Plan& plan,
                                        PlanStats& stats, PlanTrace* trace) {
  StageTimer timer;
  const TargetField& target = task.target;
  const double maximum = task.maximum = highest_pressure(target, max_cells);
  if (maximum < 0.0) return PlanStatus::InvalidTarget;
  PatchPlanner* fit = fits.empty() ? nullptr : fits[static_cast<std::size_t>(task.patch)].get();
  if (!has_pressure(target, maximum)) {
    if (fit != nullptr) fit->reset();
    return PlanStatus::EmptyTarget;
  }
  if (fit != nullptr) {
    if (trace != nullptr) *trace = {};
    task.full_scale = full_scale(std::max(highest, maximum));
    fit->plan_patch(task, plan, stats);
    return PlanStatus::Planned;
  }
  collect_points(target, maximum);
  stats.init += timer.lap();

  stats.lloyd_iterations += kmeans.run(settings.clusters, settings.lloyd_iterations,
                                       static_cast<std::uint64_t>(settings.seed), clusters);
  stats.clusters += static_cast<int>(clusters.centre.size());
  stats.kmeans += timer.lap();

  initial_paths(task.paths, stats, timer, target.origin, trace);

  const RefineResult refined = refiner.run(raster, x);
  stats.cost += refined.cost;
  stats.refine_iterations += refined.iterations;
  stats.cost_evaluations += refined.evaluations;
  if (settings.traits().makes_valid) {
    const int kept = make_valid(x, settings.samples, kMmPerMetre * settings.max_length());
    x.resize(static_cast<std::size_t>(kept) * static_cast<std::size_t>(settings.samples));
  }
  append(target, task.patch, maximum, plan, stats);
  stats.refine += timer.lap();
  return PlanStatus::Planned;
}

Planner::Planner(const PlanSettings& settings, std::size_t max_cells) {
  validate(settings);
  scratch_ = std::make_unique<Scratch>(settings, max_cells);
}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

const PlanSettings& Planner::settings() const {
  return scratch_->settings;
}

PlanStatus Planner::plan(const TargetField& target, Plan& plan, PlanStats& stats,
                         PlanTrace* trace) noexcept {
  StageTimer timer;
  plan.clear();
  stats = {};
  const PatchTask task{.target = target,
                       .paths = scratch_->settings.paths,
                       .budget = scratch_->settings.budget,
                       .time = scratch_->next_time()};
  const PlanStatus status = scratch_->plan_patch(task, 0.0, plan, stats, trace);
  stats.total = timer.seconds();
  return status;
}

PlanStatus Planner::plan(const TargetFrame& frame, Plan& plan, PlanStats& stats) noexcept {
  StageTimer timer;
  plan.clear();
  stats = {};
  // the pressure of each patch
  PatchPressures pressure{};
  double highest = 0.0;
  for (std::size_t i = 0; i < frame.patches.size(); ++i) {
    const double maximum = highest_pressure(frame.patches[i], scratch_->max_cells);
    if (maximum < 0.0) return PlanStatus::InvalidTarget;
    highest = std::max(highest, maximum);
    // the sum ignores the weights (P17)
    if (scratch_->has_pressure(frame.patches[i], maximum))
      pressure[i] = total_pressure(frame.patches[i]);
  }
  const std::array<int, kMaxPatches> share = share_out(pressure, scratch_->settings.paths);
  const auto planned = std::count_if(share.begin(), share.end(), [](int n) { return n > 0; });
  const double budget =
      scratch_->settings.budget / static_cast<double>(std::max<std::ptrdiff_t>(planned, 1));
  for (std::size_t i = 0; i < frame.patches.size(); ++i) {
    if (share[i] == 0 && pressure[i] > 0.0) continue;
    const PatchTask task{.target = frame.patches[i],
                         .patch = static_cast<int>(i),
                         .paths = share[i],
                         .budget = budget,
                         .is_alone = planned < 2,
                         .time = frame.time};
    scratch_->plan_patch(task, highest, plan, stats, nullptr);
  }
  // a hand that has left starts without a previous plan when it comes back
  for (std::size_t i = frame.patches.size(); i < scratch_->fits.size(); ++i) {
    scratch_->fits[i]->reset();
  }
  stats.total = timer.seconds();
  return plan.paths.empty() ? PlanStatus::EmptyTarget : PlanStatus::Planned;
}

void Planner::reset() noexcept {
  for (const auto& fit : scratch_->fits) fit->reset();
}

}  // namespace prostm
