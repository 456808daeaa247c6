#pragma once
/// Smoke that blows at the hands, as a world.

#include <memory>

#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/world.hpp"

namespace prostm {

/// Makes the smoke of the settings' scene. @param pool outlives it.
/// @throws std::invalid_argument with a sentence.
std::unique_ptr<World> make_smoke_world(const PipelineSettings& settings, WorkerPool& pool);

}  // namespace prostm
