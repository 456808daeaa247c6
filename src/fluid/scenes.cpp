#include <stdexcept>

#include "core/units.hpp"
#include "fluid/fluid.hpp"

namespace prostm {
using namespace literals;

Scene scene_from_name(const std::string& name) {
  // radii and speeds are tuned on a flat palm 0.2 m above the array (docs/design.md, section 3.6)
  if (name == "one-plume") return {name, {SmokeJet{Vec2(0, 0), 60_mm, 0.50}}, 0.16, 0.05};
  if (name == "four-plumes") {
    Scene scene{name, {}, 0.50, 0.30};
    for (const double x : {-24.0_mm, 24.0_mm}) {
      for (const double y : {-24.0_mm, 24.0_mm}) scene.jets.push_back({Vec2(x, y), 18_mm, 1.20});
    }
    return scene;
  }
  // ½ρv² of a palm at 0.65 m/s
  if (name == "still-air") return {name, {}, 0.25, 0.0};
  throw std::invalid_argument("the scene \"" + name +
                              "\" is unknown; it must be one-plume, four-plumes or still-air");
}

}  // namespace prostm
