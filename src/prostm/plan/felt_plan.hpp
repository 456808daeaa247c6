#pragma once
/// The percept of a plan in step according to the planner's model, in double precision: the
/// reference for the felt step, and a tool for choosing pressures by other means. Equations (W1) to
/// (W3) of docs/design/planner-felt.md.

#include <span>
#include <vector>

#include "prostm/acoustics/skin/skin_model.hpp"
#include "prostm/felt/felt_tables.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// A block of the target's skin; the model is evaluated per block, not per cell.
struct FeltBlock {
  Vec2 position = Vec2::Zero();  ///< mean position of its skin, in P [m]
  double area = 0.0;             ///< share of the skin
  double pressure = 0.0;         ///< mean p* over the target's maximum
};

/// The percept, and the gradient of its rendering error.
struct FeltPlan {
  double lack = 0.0;  ///< mean of 1 − S_8.5 + 0.3 (1 − S_0) of √e over the skins, (W3)
  std::vector<FeltBlock> blocks;
  /// √e by skin and block [m], if the plan's pressures are in Pa.
  std::vector<std::vector<double>> percept;
  std::vector<std::vector<double>> by_pressure;  ///< ∂lack/∂p by path and point
  std::vector<std::vector<Vec2>> by_point;       ///< ∂lack/∂x by path and point [1/m]
};

/// Computes the percept of paths of one patch in step. Each path starts at its first point and
/// makes loop / period laps per loop, rounded. The skin is assumed flat.
/// @param sigma fall-off of a focus [m].
/// @throws std::invalid_argument for a plan that is not in step, has foci, paths on two hands, a
/// path of fewer than 3 points or without length, or no pressure; for no skin; for a target that
/// validate() refuses, or without pressure that counts; for σ not in 1 to 50 mm.
FeltPlan felt_plan(const Plan& plan, const TargetField& target, double sigma,
                   std::span<const SkinSettings> skins);

}  // namespace prostm
