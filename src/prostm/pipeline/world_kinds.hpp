#pragma once
/// The kinds of worlds, for --world and settings, with their scenes.

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "prostm/core/worker_pool.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/world.hpp"

namespace prostm {

/// A scene of a world.
struct WorldScene {
  std::string_view name;             ///< in --scene and settings
  std::string_view label;            ///< for people
  double full_scale_pressure = 0.0;  ///< target pressure that maps to full output [Pa]
};

struct WorldKind {
  const char* name;  ///< in --world and settings
  const char* help;  ///< what presses on the hands, a noun
  /// Returns its scenes in the order in which to show them, one at least; the first is the default.
  std::span<const WorldScene> (*scenes)();
  /// Makes the world of the settings' scene, which is one of scenes(). @param pool outlives it.
  /// @throws std::invalid_argument with a sentence.
  std::unique_ptr<World> (*make)(const PipelineSettings& settings, WorkerPool& pool);
};

/// The worlds of this build; the first is the default. A program may use a table of its own.
std::span<const WorldKind> world_kinds();

/// @throws std::invalid_argument that lists the names for any other.
const WorldKind& world_named(std::string_view name,
                             std::span<const WorldKind> kinds = world_kinds());
/// The scene of a kind. @throws std::invalid_argument that lists the kind's scenes for any other.
const WorldScene& scene_named(std::string_view name, const WorldKind& kind);

/// Chooses a kind, and its default scene.
void choose_world(const WorldKind& kind, PipelineSettings& settings);

/// Makes the world that the settings name. @param pool outlives it.
/// @throws std::invalid_argument with a sentence, also for a scene of another world.
std::unique_ptr<World> make_world(const PipelineSettings& settings, WorkerPool& pool,
                                  std::span<const WorldKind> kinds = world_kinds());

/// How an option's help lists the worlds: "smoke (default; jets of smoke)".
std::string world_choices(std::span<const WorldKind> kinds = world_kinds());
/// The same for scenes: those of the default world, then those of each other, with its name.
std::string scene_choices(std::span<const WorldKind> kinds = world_kinds());

}  // namespace prostm
