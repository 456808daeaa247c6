#include "felt/chosen_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "prostm/felt/felt_tables.hpp"
#include "prostm/felt/step_path.hpp"
#include "prostm/plan/detail/fit/felt/demand.hpp"
#include "prostm/plan/felt_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/physical.hpp"

namespace prostm::bench {
namespace {

constexpr double kMm = 1e3;  // per metre

/// Returns the output (P20) that a plan in step demands [unit of its pressures].
double demanded_output(const Plan& plan) {
  const std::size_t samples = plan.paths.front().points.size();
  std::vector<StepPath<float>> paths;
  std::vector<float> pressure;
  for (const FocalPath& path : plan.paths) {
    std::vector<float> x, y;
    for (const Vec2& point : path.points) {
      x.push_back(static_cast<float>(kMm * point.x()));
      y.push_back(static_cast<float>(kMm * point.y()));
    }
    for (const double p : path.pressure) pressure.push_back(static_cast<float>(p));
    paths.emplace_back().set(x, y, static_cast<int>(std::round(plan.loop / path.period)));
  }
  planning::Demand demand;
  demand.set(paths, samples);
  return static_cast<double>(demand.normalise(pressure));
}

double cost_of(const Plan& plan, const TargetField& target, double sigma, double weight) {
  const FeltPlan felt = felt_plan(plan, target, sigma, felt_skins());
  const double strongest = *std::ranges::max_element(felt.percept.front());
  return felt.lack - weight * std::log(strongest / demanded_output(plan));
}

}  // namespace

Way chosen_paths(const std::string& name, const PlanSettings& settings, double weight,
                 const TransducerArray& array) {
  return {name, [=](const TargetField& first) -> Planning {
            PlanSettings each = settings;
            each.sigma = sigma_on_skin(array, first, PlanSettings().sigma);
            std::vector<std::shared_ptr<Planner>> planners;
            for (each.paths = 1; each.paths <= settings.paths; ++each.paths)
              planners.push_back(std::make_shared<Planner>(each, first.size()));
            return [planners, weight, sigma = each.sigma](const TargetField& target) {
              Plan best, plan;
              PlanStats stats;
              double least = std::numeric_limits<double>::infinity();
              for (const auto& planner : planners) {
                planner->plan(target, plan, stats);
                const double cost = cost_of(plan, target, sigma, weight);
                if (cost >= least) continue;
                least = cost;
                best = plan;
              }
              return best;
            };
          }};
}

}  // namespace prostm::bench
