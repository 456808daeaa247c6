#pragma once
/// How well what is felt of a plan renders its target, once an array plays it.

#include "prostm/acoustics/array.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// A plan on the skin as one loop, tilt made up for. Without a full scale in the
/// settings the plan's own largest pressure is it. @throws std::invalid_argument with a sentence:
/// a plan without pressure anywhere, and as loop_samples() does.
LoopSamples plan_loop(const Plan& plan, const TargetFrame& frame, const EmitSettings& settings,
                      double sample_rate);

/// skill_8 of the percept against the target of one patch: plan_loop() as `array` plays it with the
/// solver Weighted in still air of 20 °C, felt by a FeelingSkin. NaN for a plan or target without
/// pressure, a loop that is silent throughout, a lap above kLongestFelt, and where is_felt() says no.
/// Takes tens of milliseconds for a hand.
/// @throws std::invalid_argument as loop_samples() and loop_drives() do.
double felt_skill(const Plan& plan, const TargetFrame& frame, int patch,
                  const EmitSettings& settings, double sample_rate, const TransducerArray& array,
                  WorkerPool& pool);

}  // namespace prostm
