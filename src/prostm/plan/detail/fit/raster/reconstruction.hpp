#pragma once
/// The reconstruction error of Eq. (1) at the optimal sample pressures, and its gradient.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/plan/detail/fit/playable.hpp"
#include "prostm/plan/detail/fit/raster/cell_tiles.hpp"

namespace prostm::planning {

/// φ below e^kLeastExponent (beyond about 5 σ) counts as 0: its squares would be denormal.
inline constexpr float kLeastExponent = -14.0F;

/// Value of φ from which a cell counts as covered, at a distance of 0.57 σ. A lower value renders
/// the field of σ as well, but leaves gaps if the focus is narrower than σ.
inline constexpr float kReach = 0.85F;

struct ReconstructionSettings {
  float sigma = 8.6F;             ///< σ of Eq. (1) [mm]
  float smoothing = 0.01F;        ///< λ of (P11), on differences of neighbouring pressures
  float weight_coverage = 0.12F;  ///< weight of (P12)
  PlayBounds bounds = PlayBounds::all(1.0F, kAnySlope);  ///< bounds of the p_i, (P18)
};

/// Effective pressures at the nodes, and the gradient of the error with respect to their positions.
struct Reconstruction {
  float error = 0.0F;
  alignas(64) NodeArray pressure;    ///< p_i / γ over the frame's maximum
  alignas(64) NodeArray gradient_x;  ///< [1/mm]
  alignas(64) NodeArray gradient_y;
};

/// Buffers of a call, allocated once.
struct ReconstructionScratch {
  explicit ReconstructionScratch(std::size_t max_tiles);

  struct alignas(32) TileFit {
    float phi[8], along[8], dx[8], dy[8];  ///< φ, t, and the vector from the closest point
    std::int32_t segment[8];               ///< closest segment, as its first node
  };
  std::vector<TileFit> fits;
  /// For each segment: Σ w φ²(1−t)², Σ w φ² t(1−t), Σ w φ² t², Σ w φ (1−t) p*.
  alignas(64) std::array<float, 4 * kMaxLoopNodes> normal;
  alignas(64) std::array<float, 4 * kMaxLoopNodes> pull;  ///< ∂E/∂(ax, ay, bx, by)
  alignas(64) NodeArray normal_end;                       ///< Σ w φ t p*

  /// Zeroes the sums of the segments that `loops` has.
  void clear(const Loops& loops);
};

/// The results that a call computes.
enum class Wanted { Pressures, PressuresAndGradient };

/// Computes the minimum over 0 ≤ p ≤ most of Σ w (p̂ − p*)² + λ Σ (p_{i+1} − p_i)² (P11), plus
/// (P12) and the cost of steep pressures (P18). p̂ is Eq. (1) at the closest point over all
/// segments, with p linear along them. The gradient is exact as long as no cell changes its closest
/// segment and no pressure enters or leaves a bound.
/// @param wanted with Pressures, the error and its gradient are left unchanged.
using ReconstructFunction = void (*)(const CellTiles& cells, const Loops& loops,
                                     const ReconstructionSettings& settings, Wanted wanted,
                                     ReconstructionScratch& scratch, Reconstruction& out);

/// Handles one cell and one segment at a time, without culling.
void reconstruct_plain(const CellTiles& cells, const Loops& loops,
                       const ReconstructionSettings& settings, Wanted wanted,
                       ReconstructionScratch& scratch, Reconstruction& out);
/// Returns the vector kernel for this processor, or the plain one where Highway has only its
/// fallbacks without vectors.
ReconstructFunction fast_reconstruct();

/// Solves the normal equations by projected Gauss-Seidel, and softens the pressures where they are
/// too steep; shared by the kernels.
void solve_pressures(const Loops& loops, const ReconstructionSettings& settings,
                     const ReconstructionScratch& scratch, Reconstruction& out);
/// Sums the gradient of the segments at the nodes, and adds the smoothing and (P18) to the error.
void gather_gradient(const Loops& loops, const ReconstructionSettings& settings,
                     const ReconstructionScratch& scratch, Reconstruction& out);

}  // namespace prostm::planning
