#include "prostm/pipeline/smoke/scene.hpp"

#include <cmath>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/core/units.hpp"

namespace prostm {
namespace {

using namespace literals;

constexpr double kForce = 0.45e-3;  // force of every scene except still air [N]

/// Thin plumes, far enough apart to be felt separately. They are guided and have an eddy viscosity,
/// without which they meander and merge. They are placed in front of the palm joint, where the hand
/// is broad.
SmokeInflow thin_plumes(const std::vector<Vec2>& centres, double speed) {
  const Vec2 ahead(0.0, 13.2_mm);
  SmokeInflow inflow{{}, 0.06, 0.965e-4, 0.10, 0.1};
  for (const Vec2& centre : centres) inflow.jets.push_back({centre + ahead, 21.3_mm, speed});
  return inflow;
}

SmokeInflow wide_plume() {
  return {{SmokeJet{Vec2(0.0, 3.0_mm), 106.4_mm, 0.316}}, 0.02, 2.46e-4};
}

/// Six jets. Air escapes from the middle between them; a closed ring of air would also press in its
/// middle.
SmokeInflow ring_of_plumes() {
  constexpr int kJets = 6;
  SmokeInflow inflow{{}, 0.06, 0.5e-4, 0.10, 0.1};
  for (int q = 0; q < kJets; ++q) {
    const double angle = 2.0 * kPi * q / kJets;
    inflow.jets.push_back(
        {Vec2(35.0_mm * std::cos(angle), 8.0_mm + 35.0_mm * std::sin(angle)), 12_mm, 0.785});
  }
  return inflow;
}

/// Puffs through a tube, so that they reach the hand unchanged.
SmokeInflow pulsing_plume() {
  return {{SmokeJet{Vec2(0.0, 15.0_mm), 30_mm, 0.422}}, 0.06, 0.95e-4, 0.10, 0.1};
}

/// Inflow through the whole floor.
SmokeInflow wind() {
  return {{SmokeJet{Vec2::Zero(), 1.0, 0.294}}, 0.0, 0.8e-4};
}

/// Scenes tuned to press with the same force on a flat closed hand with its skin 0.2 m above the
/// array (docs/design/scenes.md).
std::vector<Scene> make_scenes() {
  constexpr double kAside = 24.2_mm, kAround = 30.6_mm;
  // a hand is wider at the knuckles than at the heel, and deflects jets outwards there
  constexpr double kHeel = kAside + 0.86_mm, kKnuckles = kAside - 0.86_mm;
  const double x = kAround * std::cos(kPi / 6.0), y = 0.5 * kAround;
  const std::vector<Vec2> two = {{-kAside, 0}, {kAside, 0}};
  const std::vector<Vec2> three = {{-x, -y}, {x, -y}, {0, kAround}};
  const std::vector<Vec2> four = {
      {-kHeel, -kAside}, {-kKnuckles, kAside}, {kHeel, -kAside}, {kKnuckles, kAside}};
  // one and four plumes have the same full scale, so that the same force gives the same output
  return {{"one-plume", "One wide plume", wide_plume(), 0.11, {1, 88e-4, kForce}},
          {"two-plumes", "Two thin plumes", thin_plumes(two, 0.58), 0.17, {2, 0.0, kForce}},
          {"three-plumes", "Three thin plumes", thin_plumes(three, 0.516), 0.12, {3, 0.0, kForce}},
          {"four-plumes", "Four thin plumes", thin_plumes(four, 0.54), 0.11, {4, 64e-4, kForce}},
          {"ring", "A ring of six plumes", ring_of_plumes(), 0.17, {}},
          {"pulsing", "A pulsing plume", pulsing_plume(), 0.36, {}, {1.0, 0.9}},
          {"wind", "Gusts of wind", wind(), 0.10, {}, {0.4, 0.4}},
          // ½ρv² for a palm at 0.65 m/s
          {"still-air", "Still air", {}, 0.25, {}}};
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

void move_to(const ScenePlace& place, const SmokeInflow& smoke, SmokeInflow& out) {
  const Eigen::Rotation2Dd turn(place.yaw);
  out = smoke;
  for (SmokeJet& jet : out.jets) {
    jet.centre = place.centre + turn * (place.size * jet.centre);
    jet.radius *= place.size;
  }
  out.viscosity *= place.size * place.size;
}

}  // namespace prostm
