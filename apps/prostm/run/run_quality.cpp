#include "run/run_quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "prostm/emit/played.hpp"
#include "prostm/io/sensation_json.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::app {
namespace {

/// The metrics of a run, in the order in which they are reported.
constexpr std::array<std::pair<const char*, double Metrics::*>, 4> kReported = {
    {{"skill_0", &Metrics::skill_0},
     {"felt_skill", &Metrics::felt_skill},
     {"sensation_level", &Metrics::sensation_level},
     {"spill", &Metrics::spill}}};

/// Returns the patch with the most pressure.
int pressed_patch(const TargetFrame& frame) {
  const auto most = std::max_element(frame.patches.begin(), frame.patches.end(),
                                     [](const TargetField& a, const TargetField& b) {
                                       return total_pressure(a) < total_pressure(b);
                                     });
  return static_cast<int>(most - frame.patches.begin());
}

/// Sets median, lowest and highest of one metric over the plans that have it.
void summarise(const std::vector<Metrics>& all, double Metrics::*metric, RunQuality& out) {
  std::vector<double> values;
  for (const Metrics& m : all) {
    if (std::isfinite(m.*metric)) values.push_back(m.*metric);
  }
  if (values.empty()) {
    for (Metrics* m : {&out.median, &out.lowest, &out.highest})
      m->*metric = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  std::sort(values.begin(), values.end());
  out.median.*metric = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
  out.lowest.*metric = values.front();
  out.highest.*metric = values.back();
}

}  // namespace

void PlanSample::offer(const WorldFrame& contact, const PlanFrame& plan) {
  // every plan so far is kept with the same probability
  const int place = offered_ < kKept ? offered_ : random_.below(offered_ + 1);
  ++offered_;
  if (place >= kKept) return;
  kept_.resize(static_cast<std::size_t>(std::min(offered_, kKept)));
  kept_[static_cast<std::size_t>(place)] = {contact.target, plan};
}

Metrics PlanSample::score(const Kept& kept, const PipelineSettings& settings, WorkerPool* pool) {
  EmitSettings emit = settings.emit;
  emit.full_scale_pressure = kept.plan.full_scale_pressure;
  const int patch = pressed_patch(kept.target);
  const auto place = static_cast<std::size_t>(patch);
  const SegmentPressures played =
      played_pressures(kept.plan.plan, kept.target, emit, kept.plan.emission_rate);
  Metrics metrics = score_plan(kept.target.patches[place], kept.plan.plan, patch,
                               kept.plan.sigma[place], settings.plan.gain_law(), &played);
  if (pool == nullptr) return metrics;
  emit.power_limit = power_limit(settings);
  try {
    const PlanPercept percept = plan_percept(kept.plan.plan, kept.target, patch, emit,
                                             settings.emission_rate(), settings.transducers, *pool);
    metrics.felt_skill = percept.skill;
    metrics.sensation_level = percept.sensation_level;
  } catch (const std::invalid_argument&) {
    // the array reaches none of its focal points
  }
  return metrics;
}

std::optional<RunQuality> PlanSample::quality(const PipelineSettings& settings,
                                              bool with_percept) const {
  if (kept_.empty()) return {};
  std::vector<Metrics> all;
  WorkerPool pool(settings.threads);
  for (const Kept& kept : kept_)
    all.push_back(score(kept, settings, with_percept ? &pool : nullptr));
  RunQuality out;
  out.plans = all.size();
  for (const auto& [name, metric] : kReported) summarise(all, metric, out);
  out.felt_plans = static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [](const Metrics& m) { return std::isfinite(m.sensation_level); }));
  return out;
}

nlohmann::ordered_json run_quality_json(const std::optional<RunQuality>& quality) {
  if (!quality) return nullptr;
  nlohmann::ordered_json json = {{"plans", quality->plans}};
  for (const auto& [name, metric] : kReported) {
    if (!std::isfinite(quality->median.*metric)) {
      json[name] = nullptr;
      continue;
    }
    json[name] = {{"median", quality->median.*metric},
                  {"lowest", quality->lowest.*metric},
                  {"highest", quality->highest.*metric}};
  }
  return json;
}

nlohmann::ordered_json run_sensation_json(const std::optional<RunQuality>& quality,
                                          const SensationInterval& interval) {
  if (!quality || quality->felt_plans == 0) return nullptr;
  nlohmann::ordered_json json = sensation_to_json(quality->median.sensation_level, interval);
  json["plans"] = quality->felt_plans;
  json["lowest_db"] = quality->lowest.sensation_level;
  json["highest_db"] = quality->highest.sensation_level;
  return json;
}

void print_run_quality(std::FILE* out, const std::string& what,
                       const std::optional<RunQuality>& quality, const SensationInterval& interval,
                       const std::string& unfelt) {
  if (!quality) return;
  const bool one = quality->plans == 1;
  fmt::print(out,
             "\nQuality of {}, estimated by the models{}; a shape of 1 is perfect, 0 is no better "
             "than an even field\n",
             what,
             one ? "" : fmt::format(": median and range of {} drawn at random", quality->plans));
  print_quality_numbers(out, quality->median, interval, unfelt, one ? nullptr : &quality->lowest,
                        one ? nullptr : &quality->highest);
}

}  // namespace prostm::app
