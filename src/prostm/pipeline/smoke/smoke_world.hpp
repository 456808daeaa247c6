#pragma once
/// The world of smoke blowing at the hands.

#include <memory>
#include <span>

#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/world.hpp"
#include "prostm/pipeline/world_kinds.hpp"

namespace prostm {

inline constexpr const char* kSmokeWorld = "smoke";  ///< in --world and settings

/// Whether the settings choose smoke.
bool is_smoke(const PipelineSettings& settings);

/// Returns the scenes of smoke/scene.hpp.
std::span<const WorldScene> smoke_world_scenes();

/// Makes the smoke of the settings' scene. @param pool must outlive the world.
/// @throws std::invalid_argument with a sentence.
std::unique_ptr<World> make_smoke_world(const PipelineSettings& settings, WorkerPool& pool);

}  // namespace prostm
