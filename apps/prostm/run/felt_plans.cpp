#include "run/felt_plans.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "field/field_words.hpp"
#include "prostm/io/sensation_json.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::app {
namespace {

/// Returns the patch with the largest pressure.
int pressed_patch(const TargetFrame& frame) {
  const auto most = std::max_element(
      frame.patches.begin(), frame.patches.end(),
      [](const TargetField& a, const TargetField& b) { return max_pressure(a) < max_pressure(b); });
  return static_cast<int>(most - frame.patches.begin());
}

}  // namespace

void FeltPlans::offer(const WorldFrame& contact, const PlanFrame& plan) {
  // every plan so far is kept with the same probability
  const int place = offered_ < kKept ? offered_ : random_.below(offered_ + 1);
  ++offered_;
  if (place >= kKept) return;
  kept_.resize(static_cast<std::size_t>(std::min(offered_, kKept)));
  kept_[static_cast<std::size_t>(place)] = {contact.target, plan.plan, plan.full_scale_pressure};
}

std::optional<FeltLevels> FeltPlans::levels(const PipelineSettings& settings) const {
  WorkerPool pool(settings.threads);
  std::vector<double> all;
  for (const Kept& kept : kept_) {
    EmitSettings emit = settings.emit;
    emit.full_scale_pressure = kept.full_scale_pressure;
    emit.power_limit = power_limit(settings);
    try {
      const double level = plan_percept(kept.plan, kept.target, pressed_patch(kept.target), emit,
                                        settings.emission_rate(), settings.transducers, pool)
                               .sensation_level;
      if (!std::isnan(level)) all.push_back(level);
    } catch (const std::invalid_argument&) {
      // the array reaches none of its focal points
    }
  }
  if (all.empty()) return {};
  std::sort(all.begin(), all.end());
  const double median = 0.5 * (all[(all.size() - 1) / 2] + all[all.size() / 2]);
  return FeltLevels{all.size(), all.front(), median, all.back()};
}

nlohmann::ordered_json felt_levels_json(const std::optional<FeltLevels>& levels,
                                        const SensationInterval& interval) {
  if (!levels) return nullptr;
  nlohmann::ordered_json json = sensation_to_json(levels->median, interval);
  json["plans"] = levels->plans;
  json["lowest_db"] = levels->lowest;
  json["highest_db"] = levels->highest;
  return json;
}

void print_felt_levels(std::FILE* out, const std::optional<FeltLevels>& levels,
                       const SensationInterval& interval) {
  if (!levels) return;
  print_sensation(out, levels->median, interval);
  if (levels->plans > 1) {
    fmt::print(out, "  (median of {} plans, {:.0f} to {:.0f} dB)\n", levels->plans, levels->lowest,
               levels->highest);
  }
}

}  // namespace prostm::app
