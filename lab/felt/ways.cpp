#include "felt/ways.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "felt/chosen_paths.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/core/random.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/physical.hpp"

namespace prostm::bench {
namespace {

/// Returns a way that plans one target after the other with a planner of this type.
template <class AnyPlanner, class Settings>
Planning planning_with(const Settings& settings, const TargetField& first) {
  const auto planner = std::make_shared<AnyPlanner>(settings, first.size());
  return [planner](const TargetField& target) {
    Plan plan;
    PlanStats stats;
    planner->plan(target, plan, stats);
    return plan;
  };
}

/// Returns a way that changes each plan of another way.
template <class Change>
Way changed(const std::string& name, const Way& way, bool is_control, const Change& change) {
  return {name,
          [=](const TargetField& first) -> Planning {
            return [change, planning = way.begin(first)](const TargetField& target) {
              return change(planning(target), target);
            };
          },
          is_control};
}

Way pro_stm(const std::string& name, const PlanSettings& base, const TransducerArray& array) {
  return {name, [base, array](const TargetField& first) {
            PlanSettings settings = base;
            settings.sigma = sigma_on_skin(array, first, PlanSettings().sigma);
            return planning_with<Planner>(settings, first);
          }};
}

/// @param sigma of the model (B2) [m]; 0: the array's. @param felt_weight of (B8).
Way am(const std::string& name, int foci, const TransducerArray& array, double sigma = 0.0,
       double felt_weight = 0.0) {
  return {name, [=](const TargetField& first) {
            AmSettings settings;
            settings.foci = foci;
            const double width = sigma_on_skin(array, first, PlanSettings().sigma);
            settings.sigma = sigma > 0.0 ? sigma : width;
            settings.felt_weight = felt_weight;
            settings.widths = {{0.2}, {0.0}, {0.0}, {width}};
            return planning_with<AmPlanner>(settings, first);
          }};
}

/// Returns the plan with each path's pressures in a random order.
Plan with_shuffled_pressures(Plan plan) {
  Random random(1);
  for (FocalPath& path : plan.paths) random.shuffle(path.pressure);
  return plan;
}

}  // namespace

Plan in_step(Plan plan, const TargetField& target, double loop) {
  plan.loop = loop;
  for (FocalPath& path : plan.paths) {
    const double length = skin_length(path, target);
    path.period = loop / std::max(1.0, std::round(loop * path.speed / length));
    path.speed = length / path.period;
  }
  return plan;
}

std::vector<Way> ways(const TransducerArray& array) {
  const PlanSettings best;
  PlanSettings paper;
  paper.preset = Preset::PaperValid;
  std::vector<Way> all = {pro_stm("best", best, array)};
  const Way plain = all[0];
  all.push_back(
      changed("best, in step", plain, false, [best](const Plan& plan, const TargetField& target) {
        return in_step(plan, target, 1.0 / best.draw_rate);
      }));
  PlanSettings by_pressures;
  by_pressures.felt_weight = 0.9;
  PlanSettings by_points = by_pressures;
  by_points.felt_points = true;
  all.push_back(pro_stm("felt A", by_pressures, array));
  all.push_back(pro_stm("felt B", by_points, array));
  for (int paths = 1; paths < best.paths; ++paths) {
    for (const auto& [name, settings] :
         {std::pair("best", best), {"felt A", by_pressures}, {"felt B", by_points}}) {
      PlanSettings fewer = settings;
      fewer.paths = paths;
      all.push_back(pro_stm(fmt::format("{}, {} {}", name, paths, paths == 1 ? "path" : "paths"),
                            fewer, array));
    }
  }
  PlanSettings quick = by_pressures;
  quick.preset = Preset::Fast;
  quick.felt_weight = 1.0;
  for (const double weight : {0.0, 0.1, 0.3}) {
    all.push_back(chosen_paths(fmt::format("1 to 4 paths, {:.1f}", weight), quick, weight, array));
  }
  all.push_back(chosen_paths("1 to 4 paths, moved", by_points, 0.1, array));
  for (const double weight : {0.0, 0.03, 0.1, 0.3, 1.0}) {
    PlanSettings preset;
    preset.preset = Preset::Felt;
    preset.strength_weight = weight;
    all.push_back(pro_stm(fmt::format("preset felt, {}", weight), preset, array));
  }
  PlanSettings in_time;
  in_time.preset = Preset::Felt;
  in_time.budget = in_time.traits().live_budget;
  all.push_back(pro_stm("preset felt, live", in_time, array));
  in_time.budget = 4e-3;
  all.push_back(pro_stm("preset felt, 4 ms", in_time, array));
  all.push_back(pro_stm("paper-valid", paper, array));
  all.push_back(am("AM, 4 foci", 4, array));
  all.push_back(am("AM, 8 foci", 8, array));
  // the best of 4, 6 and 8 foci with the array's width, 8.6, 12 and 16 mm, on the set for tuning
  all.push_back(am("AM, 6 foci, 16 mm", 6, array, 16e-3));
  all.push_back(am("AM, 6 foci, felt", 6, array, 16e-3, 1.0));
  all.push_back(am("AM, 8 foci, felt", 8, array, 0.0, 1.0));
  all.push_back(
      changed("shuffled pressures", plain, true,
              [](const Plan& plan, const TargetField&) { return with_shuffled_pressures(plan); }));
  all.push_back(
      changed("four circles", plain, true, [best](const Plan&, const TargetField& target) {
        return circles_at_mass_centres(target, best.gain_law(), best.max_length(), 1);
      }));
  return all;
}

}  // namespace prostm::bench
