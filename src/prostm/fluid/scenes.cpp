#include <cmath>
#include <stdexcept>

#include "prostm/core/units.hpp"
#include "prostm/fluid/fluid.hpp"

namespace prostm {
using namespace literals;

namespace {

/// Thin plumes that are far enough apart to be felt as places of their own. The fewer there are
/// the more each of them presses: they slow each other.
Scene thin_plumes(const std::string& name, double full_scale, const std::vector<Vec2>& centres) {
  Scene scene{name, {}, full_scale, 0.30};
  for (const Vec2& centre : centres) scene.jets.push_back({centre, 18_mm, 1.20});
  return scene;
}

}  // namespace

Scene scene_from_name(const std::string& name) {
  constexpr double kAside = 24.0_mm, kAround = 33.9_mm;
  // radii and speeds are tuned on a flat palm 0.2 m above the array (docs/design.md, section 3.6)
  if (name == "one-plume") return {name, {SmokeJet{Vec2(0, 0), 60_mm, 0.50}}, 0.16, 0.05};
  if (name == "two-plumes") return thin_plumes(name, 0.66, {{-kAside, 0}, {kAside, 0}});
  if (name == "three-plumes") {
    const double x = kAround * std::cos(kPi / 6.0), y = 0.5 * kAround;
    return thin_plumes(name, 0.62, {{-x, -y}, {x, -y}, {0, kAround}});
  }
  if (name == "four-plumes") {
    return thin_plumes(
        name, 0.50, {{-kAside, -kAside}, {-kAside, kAside}, {kAside, -kAside}, {kAside, kAside}});
  }
  // ½ρv² of a palm at 0.65 m/s
  if (name == "still-air") return {name, {}, 0.25, 0.0};
  throw std::invalid_argument("the scene \"" + name +
                              "\" is unknown; it must be one-plume, two-plumes, three-plumes, "
                              "four-plumes or still-air");
}

}  // namespace prostm
