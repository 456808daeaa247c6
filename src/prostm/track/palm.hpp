#pragma once
/// Position, orientation and size of a palm.

#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// A palm computed from the joints of a hand, in the hand's frame (D in the pipeline).
struct Palm {
  Vec3 centre = Vec3::Zero();  ///< the palm joint [m]
  /// angle about z from +y to the direction from the wrist to the middle finger's knuckle [rad]
  double yaw = 0.0;
  /// angle between the palm's plane (wrist, knuckles of index and little finger) and the level
  /// plane, 0 to π/2 [rad]
  double tilt = 0.0;
  /// mean of two ratios to a hand of average size: length from wrist to middle knuckle, and breadth
  /// from index to little knuckle
  double size = 1.0;
  /// least of the four fingers' ratios of the distance from knuckle to tip to the sum of the bones;
  /// 1 is straight
  double straightness = 1.0;
};

Palm palm_of(const Hand& hand);

}  // namespace prostm
