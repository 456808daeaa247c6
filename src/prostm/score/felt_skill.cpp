#include "prostm/score/felt_skill.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "prostm/emit/compensation.hpp"
#include "prostm/score/felt.hpp"

namespace prostm {

LoopSamples plan_loop(const Plan& plan, const TargetFrame& frame, EmitSettings settings,
                      double sample_rate) {
  LiftedPlan lifted;
  lift(plan, frame, lifted);
  compensate_tilt(lifted, frame, settings.tilt_bound);
  double largest = 0.0;
  for (const LiftedPath& path : lifted.paths) {
    for (const double p : path.pressure) largest = std::max(largest, p);
  }
  for (const LiftedFocus& focus : lifted.foci) largest = std::max(largest, focus.pressure);
  if (largest <= 0.0) {
    throw std::invalid_argument(
        "the plan has no pressure anywhere, so there is no field to compute");
  }
  if (settings.full_scale_pressure == 0.0) settings.full_scale_pressure = largest;
  settings.foci =
      std::max(settings.foci, static_cast<int>(lifted.paths.size() + lifted.foci.size()));
  return loop_samples(lifted, settings, sample_rate);
}

double felt_skill(const Plan& plan, const TargetFrame& frame, int patch,
                  const EmitSettings& settings, double sample_rate, const TransducerArray& array,
                  WorkerPool& pool) {
  const TargetField& target = frame.patches[static_cast<std::size_t>(patch)];
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (plan.empty() || !(max_pressure(target) > 0.0)) return kUnknown;
  const LoopSamples loop = plan_loop(plan, frame, settings, sample_rate);
  if (!is_felt(target, loop)) return kUnknown;
  const Medium air;
  LoopDriveResult drives;
  loop_drives(
      array, air, loop, {}, [](int, int) { return true; }, drives);
  const FeltField felt =
      FeelingSkin(target).feel(PackedArray(array, air), air, target, loop, drives, pool);
  return score_physical(target, felt.percept, 0.0).skill_8;
}

}  // namespace prostm
