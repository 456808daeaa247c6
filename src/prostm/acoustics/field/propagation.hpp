#pragma once
/// The propagation matrix from transducers to points, input of the focus solvers.

#include <Eigen/Core>
#include <span>

#include "prostm/acoustics/array/array.hpp"

namespace prostm {

/// G: complex acoustic pressure (rms) at point m for unit drive of transducer n [Pa], M × N.
using Propagation = Eigen::MatrixXcd;

/// Least distance of a point from a transducer [m]; (A1) is a far field.
inline constexpr double kNearestPoint = 10e-3;
/// Focal points nearer to each other than this count as duplicates [m].
inline constexpr double kNearestFoci = 1e-4;

/// Returns G for the focal points given in D, by (A1).
/// @throws std::invalid_argument for no focal point or more than there are transducers; a focal
/// point that is not finite, within kNearestPoint of a transducer, behind all transducers of a
/// directional array, or within kNearestFoci of another.
Propagation propagation_to(const TransducerArray& array, const Medium& medium,
                           std::span<const Vec3> foci);

}  // namespace prostm
