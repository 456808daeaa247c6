#include "prostm/plan/detail/fit/felt/felt_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prostm/plan/detail/fit/felt/plain_loops.hpp"
#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

constexpr std::size_t kRoughCells = 150;  // cells on which plans are compared, and points move
constexpr double kShortBudget = 6e-3;  // [s]; within it, pressures are chosen on these cells, too
constexpr FeltEffort kRoughEffort = {8, 0.5F};  // descent of each plan that is compared
// descents of the chosen plan: points, then pressures, first of a new plan, then from the last one
constexpr FeltEffort kMoving = {25, 0.5F}, kMoved = {12, 0.5F};
constexpr FeltEffort kMovingOn = {8, 0.3F}, kMovedOn = {6, 0.5F};
constexpr FeltEffort kBriefly = {6, 0.3F};  // each of them within a short budget
constexpr double kFirst = 2e-3;             // assumed time of the first plan of a candidate [s]
constexpr float kSpillWeight = 1.5F, kSpillAllowed = 0.06F;  // of the spill in (P25)
constexpr int kRefiningRounds = 4;                           // of moving points and mending paths
constexpr int kFollowingRounds = 2;   // the same for a plan that continues the last one
constexpr int kPlansPerRival = 3;     // plans of a sequence for each comparison
constexpr float kHysteresis = 0.04F;  // cost that another candidate must save
constexpr float kCountChange =
    0.02F;  // the same for another number of paths, when all are made anew

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

bool is_short(double budget) {
  return budget > 0.0 && budget <= kShortBudget;
}

FeltTuning fine_tuning(double budget) {
  const bool brief = is_short(budget);
  FeltTuning tuning;
  tuning.moving = brief ? kBriefly : kMoving;
  tuning.moving_on = brief ? kBriefly : kMovingOn;
  tuning.from_moved = brief ? kBriefly : kMoved;
  tuning.from_moved_on = brief ? kBriefly : kMovedOn;
  return tuning;
}

/// Few cells, and the nominal skin alone.
FeltScope rough_scope(const std::shared_ptr<FeltTables>& tables) {
  return {.most_cells = kRoughCells, .skins = 1, .tables = tables};
}

/// Returns the scope of the pressures of a chosen plan.
FeltScope fine_scope(double budget, const std::shared_ptr<FeltTables>& tables) {
  return is_short(budget) ? rough_scope(tables) : FeltScope{.tables = tables};
}

/// Bounds of a circle or a line to start from.
LoopBounds loop_bounds(const PlanSettings& settings, const TargetField& target) {
  constexpr double kWidth = 1.5;  // of a traced line, over σ
  return {.least_length = kMmPerMetre * std::min(settings.least_length, settings.max_length()),
          .most_length = kMmPerMetre * settings.max_length(),
          .width = kWidth * kMmPerMetre * settings.sigma_on(target)};
}

/// Returns the task of planning at most `paths` paths, whose search is short enough for any budget.
PatchTask with_paths(PatchTask task, int paths) {
  task.paths = paths;
  task.budget = 0.0;
  return task;
}

}  // namespace

FeltPlanner::FeltPlanner(const PlanSettings& settings, std::size_t max_cells,
                         const std::shared_ptr<FeltTables>& tables)
    : settings_(settings),
      rough_(step_settings(settings, false), rough_tuning(), rough_scope(tables),
             FeltLoudness::Highest),
      moving_(step_settings(settings, true), fine_tuning(settings.budget), rough_scope(tables),
              FeltLoudness::Highest),
      fine_(step_settings(settings, false), fine_tuning(settings.budget),
            fine_scope(settings.budget, tables), FeltLoudness::Highest),
      thorough_(step_settings(settings, true), {},
                {.most_cells = kFinerFeltCells, .tables = tables}, FeltLoudness::Highest),
      regions_(max_cells),
      spare_(std::make_unique<FitPlanner>(settings, max_cells)) {
  const auto add = [&](int paths, Start start) {
    candidates_.push_back(
        {std::make_unique<FitPlanner>(settings, max_cells), paths, start, kFirst});
  };
  // a short budget compares only the first
  for (int paths = settings.paths; paths >= 1; --paths) add(paths, Start::Stops);
  add(1, Start::Circle);
  add(1, Start::Line);
  rated_.reserve(candidates_.size());
}

void FeltPlanner::reset() {
  fine_.forget();
  count_.forget();
  chosen_ = kNone;
  rival_ = 0;
  plans_ = 0;
}

/// Returns (P25), as felt on the cells and skins of `step`.
float FeltPlanner::cost(Candidate& candidate, FeltStep& step) {
  const FeltRating rating = candidate.fit->rate(step);
  return rating.lack + kSpillWeight * std::max(0.0F, rating.spill - kSpillAllowed) -
         static_cast<float>(settings_.strength_weight) * std::log(rating.strength);
}

/// Returns the cost of changing the number of paths to that of a candidate.
float FeltPlanner::change_cost(const Candidate& candidate) const {
  return count_.paths() == 0 || candidate.paths == count_.paths() ? 0.0F : kCountChange;
}

/// Makes a candidate's plan anew, up to its pressures on few cells. @return its cost.
float FeltPlanner::plan_roughly(const PatchTask& task, Candidate& candidate, PlanStats& stats) {
  const StageTimer all;
  if (candidate.start == Start::Stops) {
    candidate.fit->reset();
    candidate.fit->find(with_paths(task, candidate.paths), stats);
  } else {
    loops_.samples = settings_.moved_samples();
    const auto set = candidate.start == Start::Circle ? start_circle : start_line;
    set(task.target, loop_bounds(settings_, task.target), loops_);
    candidate.fit->find_from(loops_, with_paths(task, candidate.paths), stats);
  }
  const StageTimer timer;
  rough_.set_target(task.target, task.maximum, candidate.fit->sigma());
  rough_.forget();
  candidate.fit->choose_felt(rough_, stats);
  const float found = cost(candidate, rough_);
  stats.refine += timer.seconds();
  candidate.seconds = updated_mean(candidate.seconds, all.seconds());
  return found;
}

/// Makes the plans of the candidates, at least of one, and sets chosen_ to the one that costs
/// least.
/// @param paths their number; 0: any.
void FeltPlanner::compare(const PatchTask& task, int paths, PlanStats& stats) {
  rated_.clear();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (candidates_[i].paths > task.paths || (paths > 0 && candidates_[i].paths != paths)) continue;
    if (!rated_.empty() && !has_time(task, candidates_[i].seconds + times_.ending)) break;
    rated_.push_back({plan_roughly(task, candidates_[i], stats) + change_cost(candidates_[i]), i});
  }
  std::ranges::sort(rated_, {}, [](const Rated& r) { return std::pair(r.cost, r.candidate); });
  chosen_ = rated_.front().candidate;
  fine_.forget();
}

/// Moves the points of a plan, which thorough_ continues, and chooses its pressures, on all cells
/// and skins. @param rounds number of repetitions. @return its cost then.
float FeltPlanner::refine(const PatchTask& task, Candidate& candidate, int rounds,
                          PlanStats& stats) {
  const StageTimer timer;
  thorough_.set_target(task.target, task.maximum, candidate.fit->sigma());
  candidate.fit->move_felt(task, thorough_, rounds, stats);
  candidate.fit->choose_felt(thorough_, stats);
  const float refined = cost(candidate, thorough_);
  stats.refine += timer.seconds();
  return refined;
}

/// Refines the plans, the cheapest first, and sets chosen_ to the one that costs least then.
/// @return false if there is no time for any.
bool FeltPlanner::refine_candidates(const PatchTask& task, PlanStats& stats) {
  float least = std::numeric_limits<float>::infinity();
  for (const Rated& rated : rated_) {
    if (!has_time(task, times_.refining)) break;
    const StageTimer timer;
    thorough_.forget();
    Candidate& candidate = candidates_[rated.candidate];
    const float refined = refine(task, candidate, kRefiningRounds, stats) + change_cost(candidate);
    times_.refining = updated_mean(times_.refining, timer.seconds());
    if (refined >= least) continue;
    least = refined;
    chosen_ = rated.candidate;
    fine_.continue_from(thorough_);
  }
  return std::isfinite(least);
}

/// Returns whether all candidates can be made anew in time.
bool FeltPlanner::has_time_for_all(const PatchTask& task) const {
  double seconds = times_.ending;
  for (const Candidate& candidate : candidates_) seconds += candidate.seconds;
  return has_time(task, seconds);
}

/// Returns whether a candidate may replace the chosen one, or be that one made anew.
bool FeltPlanner::may_follow(const PatchTask& task, std::size_t candidate) const {
  const int paths = candidates_[candidate].paths;
  if (!is_lost()) return candidate != chosen_ && paths <= task.paths && count_.may_change();
  return paths <= task.paths && (count_.may_change() || paths == count_.paths());
}

/// Makes the next candidate anew, by turns, and chooses it if it costs less than the last plan.
/// @return whether it was chosen.
bool FeltPlanner::replace(const PatchTask& task, PlanStats& stats) {
  const bool lost = is_lost();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    rival_ = (rival_ + 1) % candidates_.size();
    if (!may_follow(task, rival_)) continue;
    Candidate& rival = candidates_[rival_];
    if (!lost && !has_time(task, rival.seconds + times_.ending)) return false;
    std::swap(rival.fit, spare_);
    const float saved = cost_ - plan_roughly(task, rival, stats);
    if (saved > (lost ? change_cost(rival) : kHysteresis)) {
      chosen_ = rival_;
      fine_.forget();
      return true;
    }
    std::swap(rival.fit, spare_);
    return false;
  }
  return false;
}

/// Continues the last plan, or a candidate that costs less, with one of which it is compared at
/// some frames.
void FeltPlanner::continue_plan(const PatchTask& task, PlanStats& stats) {
  const bool replaced = ++plans_ % kPlansPerRival == 0 && replace(task, stats);
  Candidate& next = candidates_[chosen_];
  if (!replaced) next.fit->find(with_paths(task, next.paths), stats);
  if (!has_time(task, times_.refining)) return end_quickly(task, stats);
  thorough_.continue_from(fine_);
  refine(task, next, kFollowingRounds, stats);
  fine_.continue_from(thorough_);
}

/// Moves the points of the chosen plan on few cells, and chooses its pressures.
void FeltPlanner::end_quickly(const PatchTask& task, PlanStats& stats) {
  const StageTimer timer;
  FitPlanner& fit = *candidates_[chosen_].fit;
  moving_.continue_from(fine_);
  moving_.set_target(task.target, task.maximum, fit.sigma());
  fit.move_felt(task, moving_, 1, stats);
  fine_.continue_from(moving_);
  fine_.set_target(task.target, task.maximum, fit.sigma());
  fit.choose_felt(fine_, stats);
  stats.refine += timer.seconds();
  times_.ending = updated_mean(times_.ending, timer.seconds());
}

/// Makes all plans anew. @param paths their number; 0: any.
void FeltPlanner::make_anew(const PatchTask& task, int paths, PlanStats& stats) {
  compare(task, paths, stats);
  if (!refine_candidates(task, stats)) end_quickly(task, stats);
  rate(task, stats);
  least_cost_ = cost_;
}

/// Sets cost_ to that of the chosen plan.
void FeltPlanner::rate(const PatchTask& task, PlanStats& stats) {
  const StageTimer timer;
  Candidate& chosen = candidates_[chosen_];
  rough_.set_target(task.target, task.maximum, chosen.fit->sigma());
  cost_ = cost(chosen, rough_);
  stats.refine += timer.seconds();
}

void FeltPlanner::plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) {
  timer_.restart();
  fine_.move(kMmPerMetre * (origin_ - task.target.origin));
  origin_ = task.target.origin;
  count_.begin(regions_.count(task.target, task.maximum), task.time);
  const bool follows = chosen_ != kNone && candidates_[chosen_].paths <= task.paths;
  const int paths = follows && !count_.may_change() ? candidates_[chosen_].paths : 0;
  if (follows && !(is_lost() && has_time_for_all(task))) {
    continue_plan(task, stats);
    rate(task, stats);
    if (is_lost() && has_time(task, times_.refining)) make_anew(task, paths, stats);
    least_cost_ = std::min(least_cost_, cost_);
  } else {
    make_anew(task, paths, stats);
  }
  candidates_[chosen_].fit->append(task, plan, stats);
  count_.take(candidates_[chosen_].paths);
}

}  // namespace prostm::planning
