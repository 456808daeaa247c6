#include "prostm/pipeline/scene.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "prostm/core/names.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using namespace literals;

/// Thin plumes that are far enough apart to be felt as places of their own.
SmokeInflow thin_plumes(const std::vector<Vec2>& centres) {
  SmokeInflow inflow{{}, 0.30};
  for (const Vec2& centre : centres) inflow.jets.push_back({centre, 18_mm, 1.20});
  return inflow;
}

/// Radii and speeds are tuned on a flat palm 0.2 m above the array (docs/design.md, section 3.6).
/// The fewer thin plumes there are the more each of them presses: they slow each other.
std::vector<Scene> make_scenes() {
  constexpr double kAside = 24.0_mm, kAround = 33.9_mm;
  const double x = kAround * std::cos(kPi / 6.0), y = 0.5 * kAround;
  return {
      {"one-plume", "One wide plume", {{SmokeJet{Vec2(0, 0), 60_mm, 0.50}}, 0.05}, 0.16},
      {"two-plumes", "Two thin plumes", thin_plumes({{-kAside, 0}, {kAside, 0}}), 0.66},
      {"three-plumes", "Three thin plumes", thin_plumes({{-x, -y}, {x, -y}, {0, kAround}}), 0.62},
      {"four-plumes", "Four thin plumes",
       thin_plumes({{-kAside, -kAside}, {-kAside, kAside}, {kAside, -kAside}, {kAside, kAside}}),
       0.50},
      // ½ρv² of a palm at 0.65 m/s
      {"still-air", "Still air", {}, 0.25}};
}

}  // namespace

std::span<const Scene> scenes() {
  static const std::vector<Scene> kScenes = make_scenes();
  return kScenes;
}

const Scene& scene_from_name(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Scene& scene : scenes()) {
    if (scene.name == name) return scene;
    names.push_back(scene.name);
  }
  refuse_name("scene", name, names);
}

ScenePlace place_under(const Palm& palm) {
  return {palm.centre.head<2>(), palm.yaw, std::clamp(palm.size, 0.7, 1.3)};
}

void move_to(const ScenePlace& place, const SmokeInflow& smoke, SmokeInflow& out) {
  const Eigen::Rotation2Dd turn(place.yaw);
  out = smoke;
  for (SmokeJet& jet : out.jets) {
    jet.centre = place.centre + turn * (place.size * jet.centre);
    jet.radius *= place.size;
  }
}

}  // namespace prostm
