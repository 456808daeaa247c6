#pragma once
/// Preconditioned L-BFGS on the positions of the samples of a few closed paths.

#include <array>
#include <vector>

#include "prostm/core/lbfgs_memory.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/detail/fit/loop_shape.hpp"
#include "prostm/plan/detail/fit/loops.hpp"
#include "prostm/plan/detail/fit/raster/reconstruction.hpp"

namespace prostm::planning {

/// Settings of the minimised cost: the reconstruction error (P11) and the costs of shape
/// (P13)–(P15).
struct FitSettings {
  ReconstructionSettings reconstruction;
  ShapeSettings shape;
};

/// A set of paths with its cost.
struct Fit {
  Loops loops;
  Reconstruction reconstruction;  ///< that of `loops`
  float cost = 0.0F;              ///< sum of error and shape costs
};

/// Sized once; allocates nothing after construction.
class Descent {
 public:
  /// @param max_tiles maximum number of tiles of later calls. @param samples samples per path.
  Descent(std::size_t max_tiles, int samples, const FitSettings& settings);

  const FitSettings& settings() const { return settings_; }
  FitSettings& settings() { return settings_; }

  /// Closest points of the cells in the last evaluation.
  const std::vector<ReconstructionScratch::TileFit>& fits() const { return scratch_.fits; }
  /// Computes `fit.reconstruction` at `fit.loops`.
  void solve(const CellTiles& cells, Fit& fit);
  /// Computes `fit.reconstruction` and `fit.cost`, for any paths.
  void evaluate(const CellTiles& cells, Fit& fit);
  /// Moves the samples downhill for at most `evaluations` evaluations; no evaluation but the first
  /// begins after the deadline. The cost never rises.
  /// @return evaluations used: fewer than allowed if no step lowers the cost.
  int run(const CellTiles& cells, Fit& fit, int evaluations, const Deadline& deadline = {});

 private:
  static constexpr std::size_t kMemory = 5;
  struct Plane {
    alignas(64) NodeArray x, y;
  };
  /// Vector operations on the nodes in use.
  struct Operations;
  void evaluate_near(const CellTiles& cells, Fit& fit);
  void find_direction(const Loops& loops, const Reconstruction& at);
  void remember(const Fit& from, const Fit& to);

  FitSettings settings_;
  ReconstructFunction reconstruct_;
  ReconstructionScratch scratch_;
  SpacedPairs pairs_;
  std::array<float, kMaxPathPoints / 2 + 1> taps_{};  // taps of the circulant preconditioner
  LbfgsMemory<Plane, kMemory> memory_;
  Plane direction_;
  Fit trial_;
};

}  // namespace prostm::planning
