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
  const char* help;  ///< noun for what presses on the hands
  /// Returns its scenes in display order, at least one; the first is the default.
  std::span<const WorldScene> (*scenes)();
  /// Makes the world of the settings' scene, which is one of scenes(). @param pool must outlive the
  /// world. @throws std::invalid_argument with a sentence.
  std::unique_ptr<World> (*make)(const PipelineSettings& settings, WorkerPool& pool);
};

/// The worlds of this build; the first is the default. A program may supply its own table.
std::span<const WorldKind> world_kinds();

/// Returns a kind by name. @throws std::invalid_argument for an unknown name, listing the names.
const WorldKind& world_named(std::string_view name,
                             std::span<const WorldKind> kinds = world_kinds());
/// Returns a scene of a kind. @throws std::invalid_argument for an unknown name, listing the kind's
/// scenes.
const WorldScene& scene_named(std::string_view name, const WorldKind& kind);

/// Selects a kind and its default scene.
void choose_world(const WorldKind& kind, PipelineSettings& settings);

/// Makes the world named by the settings. @param pool must outlive the world.
/// @throws std::invalid_argument with a sentence, also for a scene of another world.
std::unique_ptr<World> make_world(const PipelineSettings& settings, WorkerPool& pool,
                                  std::span<const WorldKind> kinds = world_kinds());

/// The list of worlds for an option's help: "smoke (default; jets of smoke)".
std::string world_choices(std::span<const WorldKind> kinds = world_kinds());
/// The list of scenes for an option's help: those of the default world, then those of each other
/// world with its name.
std::string scene_choices(std::span<const WorldKind> kinds = world_kinds());

}  // namespace prostm
