#include "bench/field_bench.hpp"

#include <algorithm>

#include "prostm/emit/played.hpp"
#include "prostm/textbook/textbook.hpp"

namespace prostm::app {
namespace {

constexpr PaperTable kPaper[] = {
    {"one-plume", {285, 1548, 2550, 744, 12, 17896, 24303}, {106, 386, 646, 235, 4, 1664, 2256}},
    {"four-plumes", {142, 948, 1224, 324, 10, 11120, 14640}, {59, 338, 554, 179, 4, 3344, 4281}}};

StageTimes times_of(const PlanStats& s) {
  StageTimes times{};
  for (std::size_t i = 0; i < kPlanStages; ++i) times[i] = value_of(plan_stages()[i], s);
  return times;
}

/// The median of each stage over the repeats of one field.
StageTimes median(const std::vector<StageTimes>& repeats) {
  StageTimes out{};
  for (std::size_t stage = 0; stage < kPlanStages; ++stage) {
    std::vector<double> t;
    for (const StageTimes& times : repeats) t.push_back(times[stage]);
    std::nth_element(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2), t.end());
    out[stage] = t[t.size() / 2];
  }
  return out;
}

PipelineSettings with_preset(PipelineSettings settings, Preset preset) {
  settings.plan.preset = preset;
  return settings;
}

}  // namespace

std::span<const PaperTable> paper_tables() {
  return kPaper;
}

void PlannerColumn::add(const StageTimes& times, const Metrics& m) {
  for (std::size_t i = 0; i < kPlanStages; ++i) stage[i].add(times[i]);
  rmse.add(m.rmse);
  correlation.add(m.correlation);
  coverage.add(m.coverage);
  skill_0.add(m.skill_0);
  skill_8.add(m.skill_8);
  spill.add(m.spill);
}

FieldBench::FieldBench(const PipelineSettings& settings, std::vector<PlannerColumn> columns,
                       int repeats)
    : settings_(settings),
      columns_(std::move(columns)),
      repeats_(repeats),
      am_(settings.am, kMaxFieldCells) {
  for (const PlannerColumn& column : columns_) {
    const bool paths = column.kind == PlannerColumn::Kind::Paths;
    planners_.push_back(paths ? std::make_unique<Planner>(
                                    playable_plan_settings(with_preset(settings, column.preset),
                                                           settings.emission_rate()),
                                    kMaxFieldCells)
                              : nullptr);
  }
}

PlanStatus FieldBench::plan(std::size_t column, const TargetField& target, Plan& plan,
                            PlanStats& stats) {
  switch (columns_[column].kind) {
    case PlannerColumn::Kind::Textbook:
      return textbook::plan(target, settings_.plan, plan, stats);
    case PlannerColumn::Kind::Paths:
      return planners_[column]->plan(target, plan, stats);
    case PlannerColumn::Kind::Foci:
      return am_.plan(target, plan, stats);
  }
  return PlanStatus::EmptyTarget;
}

void FieldBench::measure(const TargetField& target) {
  std::vector<Plan> plans(columns_.size());
  std::vector<std::vector<StageTimes>> times(columns_.size());
  for (int r = 0; r < repeats_; ++r) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      PlanStats stats;
      if (plan(c, target, plans[c], stats) != PlanStatus::Planned) return;
      times[c].push_back(times_of(stats));
    }
  }
  for (std::size_t c = 0; c < columns_.size(); ++c)
    columns_[c].add(median(times[c]), score(columns_[c], target, plans[c]));
}

/// Scores the field as it is played.
Metrics FieldBench::score(const PlannerColumn& column, const TargetField& target,
                          const Plan& plan) const {
  const bool foci = column.kind == PlannerColumn::Kind::Foci;
  const SegmentPressures played = played_pressures(
      plan, target, emit_settings(settings_, max_pressure(target)), settings_.emission_rate());
  return score_plan(target, plan, 0, foci ? settings_.am.sigma : settings_.plan.sigma,
                    settings_.plan.gain_law(), &played);
}

}  // namespace prostm::app
