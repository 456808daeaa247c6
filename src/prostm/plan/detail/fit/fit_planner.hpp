#pragma once
/// Planning by reconstruction: the presets `fast` and `best` for one patch.

#include <array>
#include <boost/container/static_vector.hpp>
#include <memory>
#include <span>

#include "prostm/plan/detail/fit/felt/felt_step.hpp"
#include "prostm/plan/detail/fit/patch_planner.hpp"
#include "prostm/plan/detail/fit/phases.hpp"
#include "prostm/plan/detail/fit/search.hpp"
#include "prostm/plan/detail/fit/spacing.hpp"
#include "prostm/plan/plan_settings.hpp"
#include "prostm/plan/plan_stats.hpp"

namespace prostm::planning {

/// Finds the paths whose field (Eq. 1) is nearest to the target, (P11)–(P15), and the starts of
/// their focal points, (P16). Keeps the last plan, so that the next can start from it.
class FitPlanner : public PatchPlanner {
 public:
  FitPlanner(const PlanSettings& settings, std::size_t max_cells, const FeltTuning& tuning = {});

  void reset() override {
    has_previous_ = false;
    last_period_ = 0.0;
    if (felt_) felt_->forget();
  }
  void plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) override;

  // The parts of plan_patch(), for planners that change the paths found before they append them.
  /// Finds valid paths with playable pressures.
  void find(const PatchTask& task, PlanStats& stats);
  /// Same, by fitting these paths alone. @param loops relative to the target's origin.
  void find_from(const Loops& loops, const PatchTask& task, PlanStats& stats);
  /// Moves the points of paths in step by their percept, and mends the paths. @param step has the
  /// task's target. @param rounds number of repetitions.
  void move_felt(const PatchTask& task, FeltStep& step, int rounds, PlanStats& stats);
  /// Chooses the pressures of paths in step by their percept. @param step has the task's target.
  void choose_felt(FeltStep& step, PlanStats& stats);
  /// Returns how the paths in step are felt. @param step has the task's target.
  FeltRating rate(FeltStep& step) const {
    return step.rate(plan_.loops, starts_, loop_, plan_.reconstruction.pressure);
  }
  /// Appends the paths to `plan`.
  void append(const PatchTask& task, Plan& plan, PlanStats& stats);
  double sigma() const { return settings_.sigma; }  ///< σ of the last target [m]

 private:
  void set_target(const PatchTask& task, PlanStats& stats);
  void finish(const PatchTask& task, const StageTimer& timer, PlanStats& stats);
  void move_to(const Vec2& origin);
  boost::container::static_vector<int, kMaxPaths> by_pressure() const;
  PlayBounds play_bounds(double gain, double speed) const;
  SpacingRule spacing_rule(double between) const;
  int space_out(const TargetField& target, int paths, SpacingRule rule);
  void take_points(int paths);
  void mend(const TargetField& target, PlanStats& stats);
  int mend_between(const TargetField& target, int paths);
  void step_together(int paths);
  void take_plan(const TargetField& target, int paths);
  void solve(const TargetField& target, int& paths, PlanStats& stats);
  bool drop_silent(int& paths);
  bool bound_lengths(const TargetField& target, int paths, double share, SpacingRule& rule);
  int drop_long(const TargetField& target, int paths, double least_length);
  void choose_starts();
  ShapeSettings shape_of(const TargetField& target);
  double skin_factor(const TargetField& target, std::span<const Vec2> loop);
  std::span<Vec2> copy_path(int k, int to);
  std::span<Vec2> points_of(int paths) {
    return std::span<Vec2>(points_).first(static_cast<std::size_t>(paths * samples_));
  }
  std::span<Vec2> path_at(int place) {
    const auto n = static_cast<std::size_t>(samples_);
    return std::span<Vec2>(points_).subspan(static_cast<std::size_t>(place) * n, n);
  }

  PlanSettings settings_;
  Search search_;
  Phases phases_;
  std::unique_ptr<FeltStep> felt_;  // null if felt_weight is 0
  const bool in_step_;              // whether paths share a loop
  const int pieces_;                // pieces of a plan per segment of the search
  Fit fit_;                         // the last plan; start of the next
  Vec2 origin_ = Vec2::Zero();      // origin of the target that fit_ is for [m]
  bool has_previous_ = false, is_flat_ = false, is_alone_ = true;
  double last_period_ = 0.0;  // period of the last plan's loop [s]
  double rendered_ = 0.0;     // effective pressure that is 1 in fit_
  double full_scale_ = 0.0;   // rendered pressure at full output
  StageTimer ending_;         // since the end of the search
  // scratch
  int samples_ = 0;                                       // samples per path of points_
  Fit plan_;                                              // fit_ with the samples of the plan
  PlayBounds bounds_ = PlayBounds::all(1.0F, kAnySlope);  // bounds of plan_
  std::array<double, kMaxPaths> factor_{}, length_{}, period_{};  // for each path of plan_
  LapStarts starts_;                                              // for each path of plan_
  CommonLoop loop_;                                               // loop of plan_, if in step
  FocalPath flat_;
  std::array<Vec2, kMaxLoopNodes> points_;  // one path after the other [mm]
  SpacingScratch spacing_;
};

}  // namespace prostm::planning
