#pragma once
/// Planning for the percept: the preset `felt` for one patch.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "prostm/plan/detail/fit/felt/felt_step.hpp"
#include "prostm/plan/detail/fit/felt/path_count.hpp"
#include "prostm/plan/detail/fit/fit_planner.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::planning {

/// Makes several plans, with every number of paths, and keeps the plan with the least cost (P25) of
/// its percept. In a sequence, continues the last plan, and compares it with others by turns. When
/// it has become worse, makes all anew, or if there is no time, one in every third plan. Within a
/// time budget, it compares, and refines, fewer.
class FeltPlanner : public PatchPlanner {
 public:
  /// @param tables shared by the planners of all patches.
  FeltPlanner(const PlanSettings& settings, std::size_t max_cells,
              const std::shared_ptr<FeltTables>& tables);

  void reset() override;
  void plan_patch(const PatchTask& task, Plan& plan, PlanStats& stats) override;

 private:
  enum class Start : std::uint8_t { Stops, Circle, Line };
  /// A way to start a plan, with its last paths.
  struct Candidate {
    std::unique_ptr<FitPlanner> fit;
    int paths;
    Start start;
    double seconds;  ///< to make a plan anew: the mean of earlier ones
  };

  /// A candidate with the cost of its plan.
  struct Rated {
    float cost;
    std::size_t candidate;
  };
  /// Time of a step of planning: the mean of earlier ones [s].
  struct StepTimes {
    double refining = 0.4;  // of a candidate
    double ending = 5e-3;   // of the quick way to choose points and pressures
  };

  bool has_time(const PatchTask& task, double seconds) const {
    return task.budget == 0.0 || timer_.seconds() + seconds <= task.budget;
  }
  /// Whether the last plan costs so much more than earlier ones that others are needed.
  bool is_lost() const { return cost_ > least_cost_ + kLost; }
  float cost(Candidate& candidate, FeltStep& step);
  float change_cost(const Candidate& candidate) const;
  float plan_roughly(const PatchTask& task, Candidate& candidate, PlanStats& stats);
  void compare(const PatchTask& task, int paths, PlanStats& stats);
  float refine(const PatchTask& task, Candidate& candidate, int rounds, PlanStats& stats);
  bool refine_candidates(const PatchTask& task, PlanStats& stats);
  bool has_time_for_all(const PatchTask& task) const;
  bool may_follow(const PatchTask& task, std::size_t candidate) const;
  bool replace(const PatchTask& task, PlanStats& stats);
  void continue_plan(const PatchTask& task, PlanStats& stats);
  void end_quickly(const PatchTask& task, PlanStats& stats);
  void make_anew(const PatchTask& task, int paths, PlanStats& stats);
  void rate(const PatchTask& task, PlanStats& stats);

  const PlanSettings settings_;
  std::vector<Candidate> candidates_;
  // for comparing plans; for the chosen plan, quickly; for a refined plan
  FeltStep rough_, moving_, fine_, thorough_;
  RegionCounter regions_;
  std::unique_ptr<FitPlanner> spare_;  // for a candidate made anew beside its last paths
  PathCount count_;
  std::size_t chosen_ = kNone, rival_ = 0;  // candidate of the last plan, and the last compared
  float cost_ = 0.0F, least_cost_ = 0.0F;   // of the last plan, and since all were compared
  int plans_ = 0;                           // since reset()
  std::vector<Rated> rated_;                // plans that are compared, the cheapest first
  StageTimer timer_;                        // since the plan began
  StepTimes times_;
  Vec2 origin_ = Vec2::Zero();  // of the last target [m]
  Loops loops_;

  static constexpr float kLost = 0.05F;  // cost by which a sequence may exceed its least
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
};

}  // namespace prostm::planning
