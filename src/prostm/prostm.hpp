#pragma once
/// Everything from a pressure field to the samples of an array: target, plan, emit, device.

#include "prostm/device/device.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/emit/emitter.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/target/target_field.hpp"
#include "prostm/version.hpp"
