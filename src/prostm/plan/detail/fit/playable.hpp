#pragma once
/// Pressures that the emission can play: its intensity, √p over that of full output, changes by no
/// more than a fixed amount in a time (E4), and so along a path that is followed at a given speed.

#include <array>

#include "prostm/plan/detail/fit/loops.hpp"

namespace prostm::planning {

/// A bound of the slope that is none.
inline constexpr float kAnySlope = 1e6F;

/// What the emission can play on each path, (P18); pressures over the frame's maximum.
struct PlayBounds {
  alignas(32) std::array<float, kMaxPaths> most;   ///< of a pressure
  alignas(32) std::array<float, kMaxPaths> slope;  ///< of √p along the path [1/mm]
  alignas(32) std::array<float, kMaxPaths> least;  ///< pressure that is not silent

  /// The same for every path.
  static PlayBounds all(float most, float slope, float least = 0.0F);
};

/// The normal equations of (P11): for each node a, diagonal·p_a + after_a·p_{a+1} +
/// after_{a−1}·p_{a−1} = right, a ± 1 being its neighbours on the path.
struct PressureEquations {
  alignas(64) NodeArray diagonal, after, right;
};

/// Moves pressures that are too steep to where the equations' quadratic form, together with
/// steepness_cost(), is least within 0 ≤ p ≤ most. @param pressure least without that cost.
void soften(const Loops& loops, const PlayBounds& bounds, const PressureEquations& equations,
            NodeArray& pressure);

/// μ Σ max(|√p_{a+1} − √p_a| − 0.98 d_a, 0)², d_a = slope · the length of the segment after a; adds
/// its gradient with respect to the nodes' places [1/mm].
float steepness_cost(const Loops& loops, const PlayBounds& bounds, const NodeArray& pressure,
                     NodeArray& gradient_x, NodeArray& gradient_y);

/// Brings pressures that are too steep, at the samples or half way between, to the nearest that are
/// not. Samples within two of one that sounds are made to sound, too: an emission that began later
/// would lag behind its whole rise.
void make_playable(const Loops& loops, const PlayBounds& bounds, NodeArray& pressure);

}  // namespace prostm::planning
