#pragma once
/// Skill of the percept of a plan emitted by an array.

#include <functional>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Lifts a plan onto the skin, compensates tilt, and returns its samples for one loop. If the
/// settings have no full scale, the plan's largest pressure is used.
/// @throws std::invalid_argument for a plan without pressure anywhere, and as loop_samples() does.
LoopSamples plan_loop(const Plan& plan, const TargetFrame& frame, const EmitSettings& settings,
                      double sample_rate);

/// Returns skill_8 of the percept against the target of one patch: plan_loop() emitted by `array`
/// with the solver Weighted in still air of 20 °C, and the percept of a FeelingSkin. Returns NaN
/// for a plan or target without pressure, a loop that is silent throughout, a lap above
/// kLongestFelt, if is_felt() is false, or if `go_on`, which is called often, returns false. Takes
/// about 0.25 s for a hand.
/// @throws std::invalid_argument as loop_samples() and loop_drives() do.
double felt_skill(
    const Plan& plan, const TargetFrame& frame, int patch, const EmitSettings& settings,
    double sample_rate, const TransducerArray& array, WorkerPool& pool,
    const std::function<bool()>& go_on = [] { return true; });

}  // namespace prostm
