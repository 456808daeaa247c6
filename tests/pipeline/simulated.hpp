#pragma once
/// Access to the simulated array of a pipeline that uses it.

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::test {

inline SimulatedArray& simulated(Pipeline& pipeline) {
  return dynamic_cast<SimulatedArray&>(pipeline.device());
}

}  // namespace prostm::test
