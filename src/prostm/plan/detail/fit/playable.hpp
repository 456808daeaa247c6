#pragma once
/// Pressures within the limits of the emission. The intensity, √p relative to full output, changes
/// at a bounded rate (E4), which bounds the slope of √p along a path followed at a given speed.

#include <array>

#include "prostm/plan/detail/fit/loops.hpp"

namespace prostm::planning {

/// A slope bound that never binds.
inline constexpr float kAnySlope = 1e6F;

/// Limits of the emission on each path, (P18); pressures are relative to the frame's maximum.
struct PlayBounds {
  alignas(32) std::array<float, kMaxPaths> most;   ///< highest pressure
  alignas(32) std::array<float, kMaxPaths> slope;  ///< steepest slope of √p along the path [1/mm]
  alignas(32) std::array<float, kMaxPaths> least;  ///< lowest pressure that is not silent

  /// Returns the same bounds for every path.
  static PlayBounds all(float most, float slope, float least = 0.0F);
};

/// The normal equations of (P11): for each node a, diagonal·p_a + after_a·p_{a+1} +
/// after_{a−1}·p_{a−1} = right, a ± 1 being its neighbours on the path.
struct PressureEquations {
  alignas(64) NodeArray diagonal, after, right;
};

/// Replaces pressures that are too steep by the minimum, within 0 ≤ p ≤ most, of the equations'
/// quadratic form plus steepness_cost(). @param pressure on entry, the minimum without that cost.
void soften(const Loops& loops, const PlayBounds& bounds, const PressureEquations& equations,
            NodeArray& pressure);

/// Returns μ Σ max(|√p_{a+1} − √p_a| − 0.98 d_a, 0)², d_a = slope · the length of the segment after
/// a; adds its gradient with respect to the nodes' positions [1/mm].
float steepness_cost(const Loops& loops, const PlayBounds& bounds, const NodeArray& pressure,
                     NodeArray& gradient_x, NodeArray& gradient_y);

/// Replaces pressures that are too steep, at the samples or half-way between, by the nearest that
/// are not. Also raises samples within two of a non-silent one above silence: an emission that
/// began later would lag behind during its whole rise.
void make_playable(const Loops& loops, const PlayBounds& bounds, NodeArray& pressure);

}  // namespace prostm::planning
