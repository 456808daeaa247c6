#pragma once
/// The scenes that a hand is held into, by name.

#include <span>
#include <string_view>

#include "prostm/fluid/fluid.hpp"
#include "prostm/stimulus/stimulus.hpp"

namespace prostm {

/// How jets swell and fall: their speed is multiplied by 1 + depth sin(2π rate t), t from the
/// start.
struct ScenePulse {
  double rate = 0.0;   ///< [Hz]
  double depth = 0.0;  ///< 0 to 1; 0: steady
};

struct Scene {
  std::string_view name;   ///< in files and on the command line
  std::string_view label;  ///< for people
  /// as it blows on a hand of average size whose palm joint is above the array's centre, fingers
  /// towards +y
  SmokeInflow smoke;
  double full_scale_pressure = 0.0;  ///< target pressure that maps to full output [Pa]
  Stimulus stimulus;
  ScenePulse pulse = {};
};

/// In the order in which to show them.
std::span<const Scene> scenes();

/// @throws std::invalid_argument that lists the names for any other.
const Scene& scene_from_name(std::string_view name);

/// Sets `out` to the flow at that place. The viscosity goes with the square of the size, so that
/// jets of another size keep as far apart over the same height. Allocates nothing if `out` has held
/// as many jets before.
void move_to(const ScenePlace& place, const SmokeInflow& smoke, SmokeInflow& out);

}  // namespace prostm
