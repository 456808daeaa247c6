#pragma once
/// Where the tracker is: its pose from points that are known in both frames.

#include <span>

#include "prostm/core/geometry.hpp"

namespace prostm {

/// The same point as the tracker sees it and as the array has it.
struct PointPair {
  Vec3 p_T, p_D;  ///< [m]
};

struct Calibration {
  Pose X_DT = Pose::Identity();  ///< of the tracker in D
  double rms = 0.0;              ///< of what is left, |p_D − X_DT p_T| [m]
  double largest = 0.0;          ///< the same at the worst point [m]
};

/// The rotation and translation, without scale, that leave the least Σ|p_D − X_DT p_T|²: (H20) of
/// docs/design.md.
/// @throws std::invalid_argument with a sentence: fewer than 3 points, numbers that are not finite,
/// points within 10 mm of one line, or points that fit a mirror image and no rotation.
Calibration calibrate(std::span<const PointPair> points);

}  // namespace prostm
