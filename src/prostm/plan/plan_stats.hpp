#pragma once
/// Status and statistics of a planner's call.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "prostm/core/geometry.hpp"
#include "prostm/core/quantity.hpp"

namespace prostm {

enum class PlanStatus : std::uint8_t {
  Planned,       ///< `plan` holds 1..paths paths
  EmptyTarget,   ///< no skin, or no pressure on it (for best, fast and felt: none of positive
                 ///< weight): `plan` holds no path
  InvalidTarget  ///< a pressure is not finite, negative or above 1e300, weights are not as
                 ///< validate() requires, the cell is not 1 µm to 1 m wide, sizes disagree, or the
                 ///< raster exceeds the capacity: `plan` holds no path
};

/// Counts of a call, and the time of each stage of Table I. `refine` includes making paths valid
/// and setting pressures.
struct PlanStats {
  double init = 0, kmeans = 0, tour = 0, split = 0, resample = 0, refine = 0, total = 0;  ///< [s]
  int clusters = 0, lloyd_iterations = 0, refine_iterations = 0, cost_evaluations = 0;
  int leaves = 0;      ///< paths after splitting, before the heaviest are kept
  double cost = 0;     ///< cost of Eqs. (2)–(5) after refinement
  int long_paths = 0;  ///< paths longer than L + 0.5 mm
  int crossings = 0;   ///< pairs of segments that cross, within and between paths
};

template <>
std::span<const Quantity<PlanStats>> quantities<PlanStats>();
/// The stages: the first of these quantities, the times of Table I, `total` last.
inline constexpr std::size_t kPlanStages = 7;
std::span<const Quantity<PlanStats>, kPlanStages> plan_stages();

/// The intermediate results of the paper's Fig. 2, for figures.
struct PlanTrace {
  std::vector<Vec2> clusters;           ///< (b) centroids [m]
  std::vector<double> cluster_mass;     ///< Σ p* of each cluster
  std::vector<int> tour;                ///< (c) the closed tour, indices of clusters
  std::vector<std::vector<int>> split;  ///< (d) the kept tours, indices of clusters
};

}  // namespace prostm
