#pragma once
/// Minimum distances between the samples of a plan's paths. All lengths in mm.

#include <array>
#include <span>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/plan/detail/fit/raster/distances.hpp"
#include "prostm/plan/plan.hpp"

namespace prostm::planning {

/// Bounds that a valid set of paths keeps.
struct SpacingRule {
  /// Least distance of two samples that are on different paths, or more than `along` apart along
  /// the same path.
  double spacing = 0.0;
  double along = 0.0;
  std::array<double, kMaxPaths> most_length{};  ///< greatest length of each path
  /// Length of the circle that replaces a path that cannot be mended, at most most_length.
  double least_length = 0.0;
};

/// The pairs of samples that are near each other, listed with a margin, so that the list stays
/// valid while the samples move a little.
class NearSamples {
 public:
  NearSamples() { listed_at_.reserve(kMaxLoopNodes); }

  /// Lists the pairs of samples nearer than `reach`, and some that are farther. @param x paths of n
  /// samples each. @pre at most kMaxLoopNodes samples.
  void list(std::span<const Vec2> x, std::size_t n, double reach, double along);
  /// Pairs on different paths.
  const NodePairs& across() const { return across_; }
  /// Pairs on one path that are farther than `along` apart on it, and some that are nearer.
  const NodePairs& own() const { return own_; }

 private:
  bool is_listed(std::span<const Vec2> x, std::size_t n, double reach, double along) const;

  NodePairs across_, own_;
  std::vector<Vec2> listed_at_;
  std::size_t n_ = 0;
  double reach_ = 0.0, along_ = 0.0;
};

/// Working memory of make_spaced().
struct SpacingScratch {
  NearSamples samples;
  NodePairs segments;
};

/// Counts the pairs of samples that are nearer than the rule allows. @param x paths of `samples`
/// points each.
int count_near_pairs(std::span<const Vec2> x, int samples, const SpacingRule& rule);

/// Whether no pair is nearer than the rule allows. @param scratch of make_spaced().
bool are_apart(std::span<const Vec2> x, int samples, const SpacingRule& rule,
               SpacingScratch& scratch);

/// Makes the paths simple, free of crossings, and spaced as the rule requires. Samples that are too
/// near are pushed apart. If that fails, a path is replaced by a circle about its centroid or
/// dropped; earlier paths of `x` take precedence. The kept paths are moved to the front. @return
/// the number of paths kept, at least one.
int make_spaced(std::span<Vec2> x, int samples, const SpacingRule& rule, SpacingScratch& scratch);

}  // namespace prostm::planning
