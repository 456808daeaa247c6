#pragma once
/// The tracker's pose from points that are known in both frames.

#include <span>

#include "prostm/core/geometry.hpp"

namespace prostm {

/// The same point in the tracker's frame and in the array's.
struct PointPair {
  Vec3 p_T, p_D;  ///< [m]
};

struct Calibration {
  Pose X_DT = Pose::Identity();  ///< pose of the tracker in D
  double rms = 0.0;              ///< rms residual |p_D − X_DT p_T| [m]
  double largest = 0.0;          ///< residual at the worst point [m]
};

/// Returns the rotation and translation, without scale, that minimise Σ|p_D − X_DT p_T|²: (H20) of
/// docs/design/hands.md.
/// @throws std::invalid_argument with a sentence: fewer than 3 points, numbers that are not finite,
/// points within 10 mm of one line, or points that fit a mirror image but no rotation.
Calibration calibrate(std::span<const PointPair> points);

}  // namespace prostm
