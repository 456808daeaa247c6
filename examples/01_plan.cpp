// A pressure field in, closed paths of focal points out.
#include <cmath>
#include <cstdio>
#include <prostm/plan/planner.hpp>

int main() {
  // A ring of pressure on 120 x 120 mm of flat skin, 200 mm above the array's centre.
  prostm::TargetField field;
  field.cell = 0.005;  // [m]
  field.resize(24, 24);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const double r = (field.position(i) - prostm::Vec2(0.0575, 0.0575)).norm();
    field.skin[i] = 1;
    field.pressure[i] = std::exp(-std::pow((r - 0.03) / 0.01, 2));  // in any unit
  }

  prostm::Planner planner(prostm::PlanSettings{}, field.size());
  prostm::Plan plan;
  prostm::PlanStats stats;
  planner.plan(field, plan, stats);

  std::printf("%zu paths\n", plan.paths.size());
  for (const prostm::FocalPath& path : plan.paths) {
    std::printf("  %zu points, %.0f mm long, %.1f ms per lap\n", path.points.size(),
                1e3 * path.length, 1e3 * path.period);
  }
}
