#include "plan/fewer_paths.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "prostm/core/worker_pool.hpp"
#include "prostm/pipeline/playable.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::app {
namespace {

// gains below these are not worth a change
constexpr double kLeastShape = 0.005, kLeastStrength = 0.5;  // of skill_8; [dB]

}  // namespace

PlanPercept percept_of(const TargetField& target, const Plan& plan,
                       const PipelineSettings& settings) {
  TargetFrame frame;
  frame.patches.push_back(target);
  WorkerPool pool(settings.threads);
  return plan_percept(plan, frame, 0, emit_settings(settings, max_pressure(target)),
                      settings.emission_rate(), settings.transducers, pool);
}

std::string fewer_paths_advice(const TargetField& target, const PipelineSettings& settings,
                               int paths, const Metrics& played) {
  int best = 0;
  PlanPercept found;
  for (int fewer = paths - 1; fewer >= 1; --fewer) {
    PipelineSettings with_fewer = settings;
    with_fewer.plan.paths = fewer;
    Plan plan;
    PlanStats stats;
    Planner planner(playable_plan_settings(with_fewer, settings.emission_rate()), target.size());
    if (planner.plan(target, plan, stats) != PlanStatus::Planned) continue;
    PlanPercept percept;
    try {
      percept = percept_of(target, plan, with_fewer);
    } catch (const std::invalid_argument&) {
      continue;  // the array reaches none of its focal points
    }
    const bool better = percept.skill >= played.felt_skill + kLeastShape &&
                        percept.sensation_level >= played.sensation_level + kLeastStrength;
    if (!better || (best > 0 && percept.skill <= found.skill)) continue;
    best = fewer;
    found = percept;
  }
  if (best == 0) return {};
  return fmt::format(
      "{} {} felt better than {}: felt shape {:.2f} instead of {:.2f}, and {:.0f} dB stronger; try "
      "--paths {} or --preset felt",
      best, best == 1 ? "path is" : "paths are", paths, found.skill, played.felt_skill,
      found.sensation_level - played.sensation_level, best);
}

}  // namespace prostm::app
