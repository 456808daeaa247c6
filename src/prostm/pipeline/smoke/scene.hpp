#pragma once
/// The scenes of smoke, by name.

#include <span>
#include <string_view>

#include "prostm/fluid/fluid.hpp"
#include "prostm/stimulus/stimulus.hpp"

namespace prostm {

/// Pulsation of jets: their speed is multiplied by 1 + depth sin(2π rate t), with t from the start.
struct ScenePulse {
  double rate = 0.0;   ///< [Hz]
  double depth = 0.0;  ///< 0 to 1; 0: steady
};

struct Scene {
  std::string_view name;   ///< in files and on the command line
  std::string_view label;  ///< for people
  /// inflow for a hand of average size with its palm joint above the array's centre and fingers
  /// towards +y
  SmokeInflow smoke;
  double full_scale_pressure = 0.0;  ///< target pressure that maps to full output [Pa]
  Stimulus stimulus;
  ScenePulse pulse = {};
};

/// Returns all scenes in display order.
std::span<const Scene> scenes();

/// Returns a scene. @throws std::invalid_argument for an unknown name, listing the names.
const Scene& scene_from_name(std::string_view name);

/// Sets `out` to the inflow at a place. The viscosity is scaled by the square of the size, so that
/// jets stay separate over the same height. Does not allocate if `out` has held as many jets
/// before.
void move_to(const ScenePlace& place, const SmokeInflow& smoke, SmokeInflow& out);

}  // namespace prostm
