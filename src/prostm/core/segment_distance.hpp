#pragma once
/// Distance from a segment.

#include <algorithm>

#include "prostm/core/geometry.hpp"

namespace prostm {

/// Returns the squared distance of a point from the segment between two others, which may coincide.
inline double segment_distance2(const Vec2& x, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp((x - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (x - a - share * along).squaredNorm();
}

}  // namespace prostm
