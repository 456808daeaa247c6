#pragma once
/// Differences that may arise when a plan is played on a hand.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prostm/plan/plan.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// A plan that is played, and the displacements of the hand.
struct Play {
  std::optional<Plan> plan;                   ///< nothing: the judged plan itself
  std::vector<Vec2> shifts = {Vec2::Zero()};  ///< of the hand in its plane [m]
};

/// A disturbance plays a plan in several ways, whose scores are averaged.
struct Disturbed {
  std::string name;
  std::function<std::vector<Play>(const Plan&, const TargetField&, std::uint64_t seed)> plays;
};

/// How strong the disturbances are; at 0 nothing changes.
struct DisturbanceSizes {
  double phase = 1.0;     ///< largest share of a lap, or of a modulation's period
  double shift = 4e-3;    ///< [m]
  double pressure = 0.1;  ///< standard deviation, as a share of each pressure
};

/// Returns four disturbances: random start phases, four times; the hand displaced, in eight
/// directions; a random relative error of each pressure; own periods. Foci without phases keep one
/// phase. In "own periods" each path has a period of its own, at the planner's speed.
std::vector<Disturbed> felt_disturbances(const DisturbanceSizes& sizes = {});

}  // namespace prostm::bench
