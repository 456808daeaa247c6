#include "felt_step/tuning.hpp"

#include <algorithm>
#include <functional>

#include "prostm/core/stage_timer.hpp"
#include "prostm/fields/felt_fields.hpp"
#include "prostm/plan/detail/fit/fit_planner.hpp"
#include "prostm/plan/felt_plan.hpp"

namespace prostm::bench {
namespace {

using planning::FeltTuning;

/// A number of the tuning, and a function that multiplies it.
struct Knob {
  const char* name;
  bool of_points;  ///< matters only where points move
  std::function<void(FeltTuning&, double factor)> multiply;
};

std::vector<Knob> knobs() {
  const auto number = [](float FeltTuning::*of) {
    return [of](FeltTuning& t, double f) { t.*of *= static_cast<float>(f); };
  };
  const auto evaluations = [](planning::FeltEffort FeltTuning::*of) {
    return [of](FeltTuning& t, double f) {
      (t.*of).evaluations = std::max(2, static_cast<int>(f * (t.*of).evaluations));
    };
  };
  const auto first_step = [](planning::FeltEffort FeltTuning::*of) {
    return [of](FeltTuning& t, double f) { (t.*of).first_step *= static_cast<float>(f); };
  };
  return {{"least_root", false, number(&FeltTuning::least_root)},
          {"near", false, number(&FeltTuning::near)},
          {"from_fit, evaluations", false, evaluations(&FeltTuning::from_fit)},
          {"from_fit, first step", false, first_step(&FeltTuning::from_fit)},
          {"from_fit_again, evaluations", false, evaluations(&FeltTuning::from_fit_again)},
          {"from_fit_again, first step", false, first_step(&FeltTuning::from_fit_again)},
          {"from_last_plan, evaluations", false, evaluations(&FeltTuning::from_last_plan)},
          {"from_last_plan, first step", false, first_step(&FeltTuning::from_last_plan)},
          {"unit", true, number(&FeltTuning::unit)},
          {"moved_near", true, number(&FeltTuning::moved_near)},
          {"moving, evaluations", true, evaluations(&FeltTuning::moving)},
          {"moving, first step", true, first_step(&FeltTuning::moving)},
          {"moving_again, evaluations", true, evaluations(&FeltTuning::moving_again)},
          {"moving_again, first step", true, first_step(&FeltTuning::moving_again)},
          {"moving_on, evaluations", true, evaluations(&FeltTuning::moving_on)},
          {"moving_on, first step", true, first_step(&FeltTuning::moving_on)},
          {"from_moved, evaluations", true, evaluations(&FeltTuning::from_moved)},
          {"from_moved, first step", true, first_step(&FeltTuning::from_moved)},
          {"from_moved_on, evaluations", true, evaluations(&FeltTuning::from_moved_on)},
          {"from_moved_on, first step", true, first_step(&FeltTuning::from_moved_on)}};
}

TargetField field_of(int number) {
  const auto kinds = static_cast<int>(fields::kFeltKinds.size());
  return fields::felt_field(fields::kFeltKinds[static_cast<std::size_t>(number % kinds)],
                            static_cast<std::uint64_t>(500 + number / kinds),
                            number % 2 == 0 ? fields::Outline::Hand : fields::Outline::Palm);
}

PlanSettings settings_of(bool points) {
  PlanSettings settings;
  settings.preset = Preset::Fast;
  settings.felt_weight = 0.8;
  settings.felt_points = points;
  return settings;
}

/// Lack and time of the two plans of a field.
struct Costs {
  Distribution lack_first, lack_second, ms_first, ms_second;
};

void measure(const TuningVariant& variant, const TargetField& field, const PlanSettings& settings,
             Costs& costs) {
  const SkinSettings skin;
  planning::FitPlanner planner(settings, field.size(), variant.tuning);
  const double maximum = *std::max_element(field.pressure.begin(), field.pressure.end());
  TargetField target = field;
  for (int round = 0; round < 2; ++round) {
    Plan plan;
    PlanStats stats;
    const StageTimer timer;
    planner.plan_patch({.target = target,
                        .maximum = maximum,
                        .full_scale = settings.gain * maximum,
                        .paths = settings.paths},
                       plan, stats);
    (round == 0 ? costs.ms_first : costs.ms_second).add(1e3 * timer.seconds());
    const double lack = felt_plan(plan, target, settings.sigma, std::span(&skin, 1)).lack;
    (round == 0 ? costs.lack_first : costs.lack_second).add(lack);
    target.origin.x() += 1e-3;
  }
}

}  // namespace

std::vector<TuningVariant> tuning_variants(bool points) {
  std::vector<TuningVariant> variants = {{"as used", {}}};
  for (const Knob& knob : knobs()) {
    if (knob.of_points != points) continue;
    for (const double factor : {0.5, 2.0}) {
      TuningVariant& changed =
          variants.emplace_back(TuningVariant{fmt::format("{} x {}", knob.name, factor), {}});
      knob.multiply(changed.tuning, factor);
    }
  }
  return variants;
}

void compare_tunings(int fields, bool points, std::vector<Row>& rows) {
  const PlanSettings settings = settings_of(points);
  const std::vector<TuningVariant> variants = tuning_variants(points);
  std::vector<Costs> costs(variants.size());
  for (int number = 0; number < fields; ++number) {
    const TargetField field = field_of(number);
    for (std::size_t v = 0; v < variants.size(); ++v)
      measure(variants[v], field, settings, costs[v]);
  }
  fmt::print("\n{}: mean lack of the first plan and of the next, and median time [ms]\n",
             points ? "Points move" : "Pressures alone");
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const Summary first = costs[v].lack_first.summary(), second = costs[v].lack_second.summary();
    fmt::print("  {:<34} {:>8.4f} {:>8.4f} {:>8.2f} {:>8.2f}\n", variants[v].name, first.mean,
               second.mean, costs[v].ms_first.summary().p50, costs[v].ms_second.summary().p50);
    const std::string name = (points ? "points, " : "") + variants[v].name;
    rows.push_back({name + ", first", "1", first, "as used", costs[0].lack_first.summary().p50});
    rows.push_back({name + ", next", "1", second, "as used", costs[0].lack_second.summary().p50});
  }
}

}  // namespace prostm::bench
