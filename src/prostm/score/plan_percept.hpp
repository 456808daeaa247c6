#pragma once
/// Skill and strength of the percept of a plan emitted by an array.

#include <functional>
#include <limits>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Lifts a plan onto the skin, compensates tilt, and returns its samples for one loop. If the
/// settings have no full scale, the plan's largest pressure is used.
/// @throws std::invalid_argument for a plan without pressure anywhere, and as loop_samples() does.
LoopSamples plan_loop(const Plan& plan, const TargetFrame& frame, const EmitSettings& settings,
                      double sample_rate);

/// Returns the sensation level of the percept of a loop [dB], (S21); NaN for a percept of zeros. A
/// loop whose highest intensity is below 1 has a lower level. @param felt for the highest full
/// scale that the array sustains.
double loop_sensation_level(const FeltField& felt, const LoopSamples& loop,
                            const TransducerArray& array);

/// How a plan is felt; NaN if it is not computed.
struct PlanPercept {
  double skill = std::numeric_limits<double>::quiet_NaN();            ///< skill_8 of the percept
  double sensation_level = std::numeric_limits<double>::quiet_NaN();  ///< [dB], (S21)
};

/// Computes the percept of one patch: plan_loop() emitted by `array` with the solver Weighted in
/// still air of 20 °C, and the percept of a FeelingSkin. It is not computed for a plan or target
/// without pressure, a loop that is silent throughout, a lap above kLongestFelt, if is_felt() is
/// false, or if `go_on`, which is called often, returns false. Takes about 0.25 s for a hand.
/// @throws std::invalid_argument as loop_samples() and loop_drives() do.
PlanPercept plan_percept(
    const Plan& plan, const TargetFrame& frame, int patch, const EmitSettings& settings,
    double sample_rate, const TransducerArray& array, WorkerPool& pool,
    const std::function<bool()>& go_on = [] { return true; });

}  // namespace prostm
