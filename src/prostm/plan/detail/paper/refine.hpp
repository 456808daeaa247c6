#pragma once
/// Path refinement: gradient descent on Eqs. (2)–(5) (the paper's section IV-C).

#include <span>
#include <vector>

#include "prostm/plan/detail/paper/costs.hpp"
#include "prostm/plan/plan_settings.hpp"

namespace prostm::planning {

/// Weights and lengths of the total cost (P6).
struct CostSettings {
  double pressure, length, intersection, bending;  ///< weights
  double segment;                                  ///< L/N [mm]
  double sigma;                                    ///< σ [mm]
  explicit CostSettings(const PlanSettings& settings);
};

struct RefineResult {
  double cost = 0.0;
  int iterations = 0, evaluations = 0;
};

/// Moves samples downhill with an Armijo line search. Sized once; run() allocates nothing.
class Refiner {
 public:
  Refiner(const CostSettings& costs, int max_paths, int samples, int max_iterations);

  /// Refines `x` (paths of `samples` points each [mm]) in place. The cost never rises.
  RefineResult run(const PressureRaster& raster, std::span<Vec2> x);

  /// (P6): the weighted sum of the four costs at `x`; `gradient` is overwritten.
  double evaluate(const PressureRaster& raster, std::span<const Vec2> x, std::span<Vec2> gradient);

 private:
  void update_pairs(std::span<const Vec2> x);

  CostSettings costs_;
  int samples_, max_iterations_;
  std::vector<SamplePair> pairs_;
  std::vector<Vec2> paired_at_, gradient_, trial_, trial_gradient_;
};

}  // namespace prostm::planning
