#pragma once
/// The pressure that a scene is meant to make, and where.

#include "prostm/core/geometry.hpp"
#include "prostm/track/palm.hpp"

namespace prostm {

/// The pressure that a scene is meant to make on a flat hand of average size.
struct Stimulus {
  int maxima = 0;              ///< 0: nothing is asked of the field
  double area = 0.0;           ///< of at least half of the largest pressure [m²]; 0: not asked
  double force = 0.0;          ///< [N]; 0: not asked
  double area_margin = 15e-4;  ///< the difference from `area` that is let pass [m²]

  /// The same of jets that are `size` times as large, and `speed` times as fast.
  Stimulus scaled(double size, double speed) const {
    return {maxima, size * size * area, size * size * speed * speed * force,
            size * size * area_margin};
  }
};

/// Where the jets of a scene are: under a palm, turned with it, as large as it.
struct ScenePlace {
  Vec2 centre = Vec2::Zero();  ///< of the palm, in D [m]
  double yaw = 0.0;            ///< as of a palm [rad]
  double size = 1.0;           ///< factor on lengths across the flow
};
/// @return with a size from 0.7 to 1.3.
ScenePlace place_under(const Palm& palm);

/// A stimulus at the size and speed of its jets, and where they are.
struct PlacedStimulus {
  Stimulus wanted;
  ScenePlace place;
};

}  // namespace prostm
