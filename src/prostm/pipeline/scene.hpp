#pragma once
/// The scenes that a hand is held into, by name.

#include <span>
#include <string_view>

#include "prostm/fluid/fluid.hpp"
#include "prostm/track/palm.hpp"

namespace prostm {

/// The pressure that a scene is meant to make on a flat hand of average size.
struct Stimulus {
  int maxima = 0;      ///< 0: nothing is asked of the field
  double area = 0.0;   ///< of at least half of the largest pressure [m²]; 0: not asked
  double force = 0.0;  ///< [N]; 0: not asked

  /// The same of jets that are `size` times as large, and `speed` times as fast.
  Stimulus scaled(double size, double speed) const {
    return {maxima, size * size * area, size * size * speed * speed * force};
  }
};

struct Scene {
  std::string_view name;   ///< in files and on the command line
  std::string_view label;  ///< for people
  /// as it blows on a hand of average size whose palm joint is above the array's centre, fingers
  /// towards +y
  SmokeInflow smoke;
  double full_scale_pressure = 0.0;  ///< target pressure that maps to full output [Pa]
  Stimulus stimulus;
};

/// In the order in which to show them.
std::span<const Scene> scenes();

/// @throws std::invalid_argument that lists the names for any other.
const Scene& scene_from_name(std::string_view name);

/// Where the jets of a scene are: under a palm, turned with it, as large as it.
struct ScenePlace {
  Vec2 centre = Vec2::Zero();  ///< of the palm, in D [m]
  double yaw = 0.0;            ///< as of a palm [rad]
  double size = 1.0;           ///< factor on lengths across the flow
};
/// @return with a size from 0.7 to 1.3.
ScenePlace place_under(const Palm& palm);
/// Sets `out` to the flow at that place. The viscosity goes with the square of the size, so that
/// jets of another size keep as far apart over the same height. Allocates nothing if `out` has held
/// as many jets before.
void move_to(const ScenePlace& place, const SmokeInflow& smoke, SmokeInflow& out);

}  // namespace prostm
