#pragma once
/// From transducers to points: the matrix that focus solvers work on.

#include <Eigen/Core>
#include <span>

#include "prostm/acoustics/array.hpp"

namespace prostm {

/// G: complex acoustic pressure (rms) at point m for unit drive of transducer n [Pa], M × N.
using Propagation = Eigen::MatrixXcd;

/// Points nearer to a transducer than this are on it: (A1) is a far field [m].
inline constexpr double kNearestPoint = 10e-3;
/// Focal points nearer to each other than this are one, given twice [m].
inline constexpr double kNearestFoci = 1e-4;

/// G for the focal points given in D, by (A1). @throws std::invalid_argument with a sentence: no
/// focal point or more than there are transducers; one that is not finite, is on a transducer, lies
/// behind all of a directional array's, or is at the place of another.
Propagation propagation_to(const TransducerArray& array, const Medium& medium,
                           std::span<const Vec3> foci);

}  // namespace prostm
