#include "prostm/pipeline/world_kinds.hpp"

#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/pipeline/smoke/smoke_world.hpp"

namespace prostm {
namespace {

constexpr WorldKind kKinds[] = {
    {kSmokeWorld, "jets of smoke", smoke_world_scenes, make_smoke_world},
};

std::vector<std::string_view> scene_names(const WorldKind& kind) {
  std::vector<std::string_view> names;
  for (const WorldScene& scene : kind.scenes()) names.push_back(scene.name);
  return names;
}

}  // namespace

std::span<const WorldKind> world_kinds() {
  return kKinds;
}

const WorldKind& world_named(std::string_view name, std::span<const WorldKind> kinds) {
  std::vector<std::string_view> names;
  for (const WorldKind& kind : kinds) {
    if (kind.name == name) return kind;
    names.emplace_back(kind.name);
  }
  refuse_name("world", name, names);
}

const WorldScene& scene_named(std::string_view name, const WorldKind& kind) {
  for (const WorldScene& scene : kind.scenes())
    if (scene.name == name) return scene;
  refuse_name("scene", name, scene_names(kind));
}

void choose_world(const WorldKind& kind, PipelineSettings& settings) {
  settings.world = kind.name;
  settings.scene = kind.scenes().front().name;
}

std::unique_ptr<World> make_world(const PipelineSettings& settings, WorkerPool& pool,
                                  std::span<const WorldKind> kinds) {
  const WorldKind& kind = world_named(settings.world, kinds);
  scene_named(settings.scene, kind);
  return kind.make(settings, pool);
}

std::string world_choices(std::span<const WorldKind> kinds) {
  std::vector<std::string> texts;
  for (const WorldKind& kind : kinds) {
    texts.push_back(std::string(kind.name) + (texts.empty() ? " (default; " : " (") + kind.help +
                    ")");
  }
  return listed(texts);
}

std::string scene_choices(std::span<const WorldKind> kinds) {
  std::string out;
  for (const WorldKind& kind : kinds) {
    if (!out.empty()) out += "; with --world " + std::string(kind.name) + ": ";
    std::vector<std::string> texts;
    for (const WorldScene& scene : kind.scenes()) texts.emplace_back(scene.name);
    texts.front() += " (default)";
    out += listed(texts);
  }
  return out;
}

}  // namespace prostm
