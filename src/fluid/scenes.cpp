#include <stdexcept>

#include "core/units.hpp"
#include "fluid/fluid.hpp"

namespace prostm {
using namespace literals;

Scene scene_from_name(const std::string& name) {
  // radii and speeds are tuned on the open hand 0.2 m above the array (docs/design.md, section 3.6)
  if (name == "one-plume") {
    return {name, {SmokeJet{Vec2(0, 0), 50_mm, 0.60}}, 0.20};
  }
  if (name == "four-plumes") {
    Scene scene{name, {}, 0.20};
    for (const double x : {-32.5_mm, 32.5_mm}) {
      for (const double y : {-32.5_mm, 32.5_mm}) scene.jets.push_back({Vec2(x, y), 20_mm, 0.80});
    }
    return scene;
  }
  throw std::invalid_argument("the scene \"" + name +
                              "\" is unknown; it must be one-plume or four-plumes");
}

}  // namespace prostm
