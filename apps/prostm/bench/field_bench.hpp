#pragma once
/// The paper's Table I for planners, on the fields of recordings.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "prostm/am/am_planner.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"

namespace prostm::app {

using StageTimes = std::array<double, kPlanStages>;  ///< [s]

/// The paper's Table I [µs] (Intel i7-6820HK, another machine): mean and standard deviation, for
/// scenes named as ours.
struct PaperTable {
  const char* scene;
  StageTimes mean, deviation;
};
std::span<const PaperTable> paper_tables();

/// The paper on AM: "update rates of roughly 250 Hz on both test scenarios".
inline constexpr double kPaperAmRate = 250.0;

/// One planner's times and quality over fields.
struct PlannerColumn {
  enum class Kind { Textbook, Paths, Foci };

  PlannerColumn(std::string planner, Kind of, Preset with = Preset::Paper)
      : name(std::move(planner)), kind(of), preset(with) {}

  std::string name;
  Kind kind;
  Preset preset;  ///< of paths
  std::array<Distribution, kPlanStages> stage;
  Distribution rmse, correlation, coverage, skill_0, skill_8, spill;

  void add(const StageTimes& times, const Metrics& m);
  Summary total() const { return stage[kPlanStages - 1].summary(); }
};

/// Times and scores planners on fields, in turn on this one thread, and takes the median of the
/// repeats. A field for which one of them finds no plan is left out for all.
class FieldBench {
 public:
  FieldBench(const PipelineSettings& settings, std::vector<PlannerColumn> columns, int repeats);

  void measure(const TargetField& target);
  const std::vector<PlannerColumn>& columns() const { return columns_; }
  std::size_t fields() const { return columns_.front().total().n; }

 private:
  PlanStatus plan(std::size_t column, const TargetField& target, Plan& plan, PlanStats& stats);
  Metrics score(const PlannerColumn& column, const TargetField& target, const Plan& plan) const;

  const PipelineSettings& settings_;
  std::vector<PlannerColumn> columns_;
  int repeats_;
  std::vector<std::unique_ptr<Planner>> planners_;  // null for columns of other kinds
  AmPlanner am_;
};

}  // namespace prostm::app
