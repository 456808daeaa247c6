#pragma once
/// Target fields of a pipeline that runs without a clock.

#include <functional>

#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm::app {

/// Returns the run time after which capture_fields() gives up [s]: a hand is away part of the time,
/// and one that never meets the smoke must not run without end.
double capture_limit(const PipelineSettings& settings, int frames);

/// Records `frames` updates with pressure, or fewer if go_on, which gets the number so far, returns
/// false. @param from earliest run time of the first [s]. @return the number recorded.
/// @throws as the pipeline and the recorder do.
int capture_fields(Pipeline& pipeline, const PipelineSettings& settings, Recorder& recorder,
                   int frames, const std::function<bool(int taken)>& go_on, double from = 0.0);

}  // namespace prostm::app
