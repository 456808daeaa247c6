#include "prostm/score/plan_percept.hpp"

#include <algorithm>
#include <stdexcept>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/emit/compensation.hpp"

namespace prostm {

namespace {

LiftedPlan lifted(const Plan& plan, const TargetFrame& frame, const EmitSettings& settings) {
  LiftedPlan out;
  lift(plan, frame, out);
  compensate_tilt(out, frame, settings.tilt_bound);
  return out;
}

LoopSamples loop_of(const LiftedPlan& plan, EmitSettings settings, double sample_rate) {
  if (settings.full_scale_pressure == 0.0) settings.full_scale_pressure = largest_pressure(plan);
  settings.foci = std::max(settings.foci, static_cast<int>(plan.paths.size() + plan.foci.size()));
  return loop_samples(plan, settings, sample_rate);
}

bool is_silent(const LoopSamples& loop) {
  return std::all_of(loop.sample.begin(), loop.sample.end(),
                     [](const FocusSample& sample) { return sample.intensity == 0.0F; });
}

}  // namespace

LoopSamples plan_loop(const Plan& plan, const TargetFrame& frame, const EmitSettings& settings,
                      double sample_rate) {
  const LiftedPlan on_skin = lifted(plan, frame, settings);
  if (largest_pressure(on_skin) <= 0.0) {
    throw std::invalid_argument(
        "the plan has no pressure anywhere, so there is no field to compute");
  }
  return loop_of(on_skin, settings, sample_rate);
}

double loop_sensation_level(const FeltField& felt, const LoopSamples& loop,
                            const TransducerArray& array) {
  double strongest = 0.0;
  for (const FocusSample& sample : loop.sample)
    strongest = std::max(strongest, static_cast<double>(sample.intensity));
  return sensation_level(strongest * strongest * felt.largest, array);
}

PlanPercept plan_percept(const Plan& plan, const TargetFrame& frame, int patch,
                         const EmitSettings& settings, double sample_rate,
                         const TransducerArray& array, WorkerPool& pool,
                         const std::function<bool()>& go_on) {
  const TargetField& target = frame.patches[static_cast<std::size_t>(patch)];
  const LiftedPlan on_skin = lifted(plan, frame, settings);
  if (!(largest_pressure(on_skin) > 0.0) || !(max_pressure(target) > 0.0)) return {};
  require_loop(plan.loop);
  if (longest_lap(on_skin, sample_rate) > kLongestFelt) return {};
  const LoopSamples loop = loop_of(on_skin, settings, sample_rate);
  if (is_silent(loop) || !is_felt(target, loop)) return {};
  const Medium air;
  LoopDriveResult drives;
  const auto progress = [&](int, int) { return go_on(); };
  if (!loop_drives(array, air, loop, {}, progress, drives)) return {};
  const FeltField felt =
      FeelingSkin(target).feel(PackedArray(array, air), air, target, loop, drives, pool);
  return {score_physical(target, felt.percept, 0.0).skill_8,
          loop_sensation_level(felt, loop, array)};
}

}  // namespace prostm
