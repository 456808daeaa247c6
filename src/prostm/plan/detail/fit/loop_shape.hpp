#pragma once
/// Costs of the shape of closed paths: length, even samples, spacing and bending.

#include <array>
#include <cstdint>
#include <vector>

#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/plan/detail/fit/raster/distances.hpp"

namespace prostm::planning {

/// Weights and bounds of (P13)–(P15); lengths in mm.
struct ShapeSettings {
  float weight_length = 3.0F, weight_spacing = 1.0F, weight_bending = 0.3F;
  float spacing = 8.6F;                        ///< samples nearer than this are pushed apart
  float least_length = 35.0F;                  ///< least length of a path
  std::array<float, kMaxPaths> most_length{};  ///< greatest length of each path
};

/// Least ratio of the distance between two samples of one path to their distance along it; a
/// smaller ratio is a fold. In a circle the ratio is at least 2/π.
inline constexpr float kLeastChord = 0.6F;

/// Two samples to be kept apart; first < second.
struct SpacedPair {
  std::uint16_t first, second;
  float distance;  ///< distance that they should keep [mm]
};

/// The pairs of non-consecutive samples that are too near or may soon be.
class SpacedPairs {
 public:
  SpacedPairs();

  /// Makes the list valid for `loops`: searches the pairs again when a sample has moved so far that
  /// a pair may be missing. Allocates nothing.
  void update(const Loops& loops, const ShapeSettings& settings);
  /// Discards the list; the next update() rebuilds it.
  void clear() { listed_ = false; }
  const std::vector<SpacedPair>& list() const { return pairs_; }

 private:
  bool has_moved(const Loops& loops) const;

  std::vector<SpacedPair> pairs_;
  NodePairs near_;
  alignas(64) NodeArray listed_x_, listed_y_;
  bool listed_ = false;
};

/// (P13) length: w_l Σ_paths [Σ (s_i − s̄)² + N max(s̄ − L/N, 0)² + N max(L_least/N − s̄, 0)²], s_i
/// the segments' lengths and s̄ their mean; (P14) spacing: w_s Σ_pairs max(distance − ‖x_j − x_i‖,
/// 0)²; (P15) bending: w_b Σ 2 (1 − cos θ_i) ≈ w_b Σ θ_i².
/// Adds the gradient to gradient_x, gradient_y. @return the cost.
float shape_cost(const Loops& loops, const ShapeSettings& settings,
                 const std::vector<SpacedPair>& pairs, NodeArray& gradient_x,
                 NodeArray& gradient_y);

}  // namespace prostm::planning
