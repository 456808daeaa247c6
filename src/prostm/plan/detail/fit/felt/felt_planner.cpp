#include "prostm/plan/detail/fit/felt/felt_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prostm/plan/detail/fit/felt/plain_loops.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

constexpr std::size_t kRoughCells = 150;  // cells on which plans are compared, and points move
constexpr FeltEffort kRoughEffort = {8, 0.5F};  // descent of each plan that is compared
// descents of the chosen plan: points, then pressures, first of a new plan, then from the last one
constexpr FeltEffort kMoving = {25, 0.5F}, kMoved = {12, 0.5F};
constexpr FeltEffort kMovingOn = {8, 0.3F}, kMovedOn = {6, 0.5F};
constexpr int kPlansPerRival = 3;     // plans of a sequence for each comparison
constexpr float kHysteresis = 0.04F;  // cost that another candidate must save
constexpr float kLost = 0.05F;        // cost by which a sequence may exceed its least

/// Settings of the felt steps, whose cost is that of the percept alone. @param points whether
/// points move.
PlanSettings step_settings(PlanSettings settings, bool points) {
  settings.felt_weight = 1.0;
  settings.felt_points = points;
  return settings;
}

FeltTuning rough_tuning() {
  FeltTuning tuning;
  tuning.from_fit = kRoughEffort;
  return tuning;
}

FeltTuning fine_tuning() {
  FeltTuning tuning;
  tuning.moving = kMoving;
  tuning.moving_on = kMovingOn;
  tuning.from_moved = kMoved;
  tuning.from_moved_on = kMovedOn;
  return tuning;
}

/// Few cells, and the nominal skin alone.
FeltScope rough_scope(const std::shared_ptr<FeltTables>& tables) {
  return {.most_cells = kRoughCells, .skins = 1, .tables = tables};
}

/// Bounds of a circle or a line to start from.
LoopBounds loop_bounds(const PlanSettings& settings, const TargetField& target) {
  constexpr double kWidth = 1.5;  // of a traced line, over σ
  return {.least_length = kMmPerMetre * std::min(settings.least_length, settings.max_length()),
          .most_length = kMmPerMetre * settings.max_length(),
          .width = kWidth * kMmPerMetre * settings.sigma_on(target)};
}

/// Returns the task of planning at most `paths` paths.
PatchTask with_paths(PatchTask task, int paths) {
  task.paths = paths;
  return task;
}

}  // namespace

FeltPlanner::FeltPlanner(const PlanSettings& settings, std::size_t max_cells,
                         const std::shared_ptr<FeltTables>& tables)
    : settings_(settings),
      rough_(step_settings(settings, false), rough_tuning(), rough_scope(tables),
             FeltLoudness::Highest),
      moving_(step_settings(settings, true), fine_tuning(), rough_scope(tables),
              FeltLoudness::Highest),
      fine_(step_settings(settings, false), fine_tuning(), {.tables = tables},
            FeltLoudness::Highest),
      regions_(max_cells) {
  const auto add = [&](int paths, Start start) {
    candidates_.push_back({FitPlanner(settings, max_cells), paths, start});
  };
  for (int paths = 1; paths <= settings.paths; ++paths) add(paths, Start::Stops);
  add(1, Start::Circle);
  add(1, Start::Line);
}

void FeltPlanner::reset() {
  fine_.forget();
  count_.forget();
  chosen_ = kNone;
  rival_ = 0;
  plans_ = 0;
}

/// Returns (P25).
float FeltPlanner::cost(Candidate& candidate) {
  const FeltRating rating = candidate.fit.rate(rough_);
  return rating.lack - static_cast<float>(settings_.strength_weight) * std::log(rating.strength);
}

/// Makes a candidate's plan anew, up to its pressures on few cells. @return its cost.
float FeltPlanner::plan_roughly(const PatchTask& task, Candidate& candidate, PlanStats& stats) {
  if (candidate.start == Start::Stops) {
    candidate.fit.reset();
    candidate.fit.find(with_paths(task, candidate.paths), stats);
  } else {
    loops_.samples = settings_.moved_samples();
    const auto set = candidate.start == Start::Circle ? start_circle : start_line;
    set(task.target, loop_bounds(settings_, task.target), loops_);
    candidate.fit.find_from(loops_, task, stats);
  }
  const StageTimer timer;
  rough_.set_target(task.target, task.maximum, candidate.fit.sigma());
  rough_.forget();
  candidate.fit.choose_felt(rough_, stats);
  const float found = cost(candidate);
  stats.refine += timer.seconds();
  return found;
}

/// Makes the plan of every candidate, and moves the points of the one that costs least. @param
/// paths their number; 0: any. @return that candidate.
std::size_t FeltPlanner::choose_among_all(const PatchTask& task, int paths, PlanStats& stats) {
  std::size_t best = kNone;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (candidates_[i].paths > task.paths || (paths > 0 && candidates_[i].paths != paths)) continue;
    const float own = plan_roughly(task, candidates_[i], stats);
    if (best != kNone && own >= least) continue;
    least = own;
    best = i;
  }
  fine_.forget();
  move_points(task, candidates_[best].fit, stats);
  return best;
}

/// Moves the points of a plan, whose pressures fine_ then continues from.
void FeltPlanner::move_points(const PatchTask& task, FitPlanner& fit, PlanStats& stats) {
  const StageTimer timer;
  moving_.continue_from(fine_);
  moving_.set_target(task.target, task.maximum, fit.sigma());
  fit.move_felt(task, moving_, 1, stats);
  fine_.continue_from(moving_);
  stats.refine += timer.seconds();
}

/// Continues the last plan, unless another candidate, with which it is compared at some frames,
/// costs less. @return the candidate.
std::size_t FeltPlanner::continue_plan(const PatchTask& task, PlanStats& stats) {
  std::size_t chosen = chosen_;
  if (++plans_ % kPlansPerRival == 0 && count_.may_change()) {
    do rival_ = (rival_ + 1) % candidates_.size();
    while (rival_ == chosen_ || candidates_[rival_].paths > task.paths);
    const float other = plan_roughly(task, candidates_[rival_], stats);
    if (other < cost_ - kHysteresis) chosen = rival_;
  }
  Candidate& next = candidates_[chosen];
  if (chosen == chosen_) {
    next.fit.find(with_paths(task, next.paths), stats);
  } else {
    fine_.forget();
  }
  move_points(task, next.fit, stats);
  return chosen;
}

void FeltPlanner::plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) {
  fine_.move(kMmPerMetre * (origin_ - task.target.origin));
  origin_ = task.target.origin;
  count_.begin(regions_.count(task.target, task.maximum), task.time);
  const bool follows = chosen_ != kNone && candidates_[chosen_].paths <= task.paths;
  const bool continues = follows && cost_ <= least_cost_ + kLost;
  const int paths = follows && !count_.may_change() ? candidates_[chosen_].paths : 0;
  chosen_ = continues ? continue_plan(task, stats) : choose_among_all(task, paths, stats);
  const StageTimer timer;
  Candidate& chosen = candidates_[chosen_];
  fine_.set_target(task.target, task.maximum, chosen.fit.sigma());
  chosen.fit.choose_felt(fine_, stats);
  chosen.fit.append(task, plan, stats);
  count_.take(chosen.paths);
  rough_.set_target(task.target, task.maximum, chosen.fit.sigma());
  cost_ = cost(chosen);
  least_cost_ = continues ? std::min(least_cost_, cost_) : cost_;
  stats.refine += timer.seconds();
}

}  // namespace prostm::planning
