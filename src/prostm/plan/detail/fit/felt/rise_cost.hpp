#pragma once
/// The cost of pressures that rise or fall faster along a path than the emission can play: (P23).

#include <span>

#include "prostm/plan/detail/fit/felt/envelope.hpp"
#include "prostm/plan/detail/fit/playable.hpp"

namespace prostm::planning {

/// Computes (P23) and adds its gradient. @param pieces pieces per segment in which the pressure is
/// linear; make_playable() bounds each. @param root √p of the points. @param gradient with respect
/// to `root`. @param gradient_x, gradient_y with respect to the points [1/mm]; may be empty.
float rise_cost(const StepPoints& points, const PlayBounds& bounds, int pieces,
                std::span<const float> root, std::span<float> gradient, std::span<float> gradient_x,
                std::span<float> gradient_y);

}  // namespace prostm::planning
