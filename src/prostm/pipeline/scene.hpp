#pragma once
/// The scenes that a hand is held into, by name.

#include <span>
#include <string_view>

#include "prostm/fluid/fluid.hpp"

namespace prostm {

struct Scene {
  std::string_view name;   ///< in files and on the command line
  std::string_view label;  ///< for people
  SmokeInflow smoke;
  double full_scale_pressure = 0.0;  ///< target pressure that maps to full output [Pa]
};

/// In the order in which to show them.
std::span<const Scene> scenes();

/// @throws std::invalid_argument that lists the names for any other.
const Scene& scene_from_name(std::string_view name);

}  // namespace prostm
