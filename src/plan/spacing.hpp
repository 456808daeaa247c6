#pragma once
/// How far apart the samples of a plan's paths are, and how paths are made to keep their distance.
/// All lengths in mm.

#include <array>
#include <span>

#include "core/geometry.hpp"
#include "plan/plan.hpp"

namespace prostm::planning {

/// What a valid set of paths keeps.
struct SpacingRule {
  double spacing = 0.0;  ///< least distance of two samples on different paths, or of two on one
                         ///< path that are
  double along = 0.0;    ///< farther than this apart along it
  std::array<double, kMaxPaths> most_length{};  ///< of each path
  double least_length = 0.0;  ///< of the circle that replaces a path which cannot be mended; less
                              ///< where the path's most_length is
};

/// Pairs of samples that are nearer than the rule allows. @param x paths of `samples` points each.
int count_near_pairs(std::span<const Vec2> x, int samples, const SpacingRule& rule);

/// Makes paths keep the rule, simple and free of crossings. Samples that are too near push each
/// other apart; where that does not end well, a path is replaced by a circle about its centroid or
/// left out, the first ones of `x` staying as they are if they can. The kept ones are moved to the
/// front. @return how many are kept, at least one.
int make_spaced(std::span<Vec2> x, int samples, const SpacingRule& rule);

}  // namespace prostm::planning
