#pragma once
/// The intended pressure of a scene, and its position.

#include "prostm/core/geometry.hpp"
#include "prostm/track/palm.hpp"

namespace prostm {

/// The intended pressure of a scene on a flat hand of average size.
struct Stimulus {
  int maxima = 0;              ///< number of maxima; 0: no requirement on the field
  double area = 0.0;           ///< area above half of the largest pressure [m²]; 0: any
  double force = 0.0;          ///< total force [N]; 0: any
  double area_margin = 15e-4;  ///< accepted difference from `area` [m²]

  /// Returns the stimulus of jets that are `size` times as large and `speed` times as fast.
  Stimulus scaled(double size, double speed) const {
    return {maxima, size * size * area, size * size * speed * speed * force,
            size * size * area_margin};
  }
};

/// Position of the jets of a scene: under a palm, rotated and scaled with it.
struct ScenePlace {
  Vec2 centre = Vec2::Zero();  ///< centre of the palm, in D [m]
  double yaw = 0.0;            ///< as Palm::yaw [rad]
  double size = 1.0;           ///< factor on lengths across the flow
};
/// Returns the place under a palm, with a size from 0.7 to 1.3.
ScenePlace place_under(const Palm& palm);

/// A stimulus, scaled to the size and speed of its jets, and their position.
struct PlacedStimulus {
  Stimulus wanted;
  ScenePlace place;
};

}  // namespace prostm
