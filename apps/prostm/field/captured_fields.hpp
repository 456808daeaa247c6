#pragma once
/// Target fields of a pipeline that runs without a clock.

#include <functional>

#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::app {

/// The run time after which capture_fields() gives up [s]: a hand is away for part of its time, and
/// one that never meets the smoke must not capture without end.
double capture_limit(const PipelineSettings& settings, int frames);

/// Records updates that have pressure until there are so many, or go_on, which is told how many
/// there are, says false. @param from run time of the first [s]. @return how many there are.
/// @throws what the pipeline or recorder throws.
int capture_fields(Pipeline& pipeline, const PipelineSettings& settings, Recorder& recorder,
                   int frames, const std::function<bool(int taken)>& go_on, double from = 0.0);

}  // namespace prostm::app
