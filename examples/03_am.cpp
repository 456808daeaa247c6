// Renders one field with moving focal points (PRO-STM) and with stationary ones (amplitude
// modulation).
#include <cstdio>
#include <prostm/am/am_planner.hpp>
#include <prostm/plan/planner.hpp>
#include <prostm/score/score.hpp>

#include "two_bumps.hpp"

int main() {
  const prostm::TargetField field = two_bumps();
  const prostm::PlanSettings settings;
  const prostm::AmSettings am_settings;
  prostm::Plan paths, foci;
  prostm::PlanStats stats;
  prostm::Planner(settings, field.size()).plan(field, paths, stats);
  prostm::AmPlanner(am_settings, field.size()).plan(field, foci, stats);

  for (const prostm::FocalPoint& focus : foci.foci) {
    std::printf("focus at (%.0f, %.0f) mm, pressure %.2f\n", 1e3 * focus.position.x(),
                1e3 * focus.position.y(), focus.pressure);
  }
  const auto score = [&](const prostm::Plan& plan) {
    return prostm::score_plan(field, plan, 0, settings.sigma_on(field), settings.gain_law());
  };
  std::printf("correlation: %zu paths %.3f, %zu foci %.3f\n", paths.paths.size(),
              score(paths).correlation, foci.foci.size(), score(foci).correlation);
}
