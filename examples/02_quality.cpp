// Scores a plan, and compares it with control paths that must score worse.
#include <cstdio>
#include <prostm/plan/planner.hpp>
#include <prostm/score/score.hpp>

#include "two_bumps.hpp"

namespace {

void print(const char* name, const prostm::Metrics& m) {
  std::printf("%-36s  correlation %.3f  rmse %.3f  skill %.3f\n", name, m.correlation, m.rmse,
              m.skill_0);
}

}  // namespace

int main() {
  const prostm::TargetField field = two_bumps();
  const prostm::PlanSettings settings;
  prostm::Planner planner(settings, field.size());
  prostm::Plan plan;
  prostm::PlanStats stats;
  planner.plan(field, plan, stats);

  const double sigma = settings.sigma_on(field);
  print("plan", prostm::score_plan(field, plan, 0, sigma, settings.gain_law()));
  for (const prostm::Control& control : prostm::controls(
           field, sigma, settings.gain_law(), settings.max_length(), nullptr, /*seed=*/1)) {
    print(control.name.c_str(), control.metrics);
  }

  // The weak bump counts five times as much: the planner sacrifices some of the strong one for it.
  prostm::TargetField weighted = field;
  for (std::size_t i = 0; i < field.size(); ++i) {
    weighted.weight.push_back(field.position(i).x() > 0.01 ? 5.0 : 1.0);
  }
  planner.reset();
  prostm::Plan other;
  planner.plan(weighted, other, stats);
  const prostm::GainLaw gain = settings.gain_law();
  std::printf("weighted rmse %.4f, %.4f when planned with the weights\n",
              prostm::weighted_rmse(weighted, plan, 0, sigma, gain),
              prostm::weighted_rmse(weighted, other, 0, sigma, gain));
}
