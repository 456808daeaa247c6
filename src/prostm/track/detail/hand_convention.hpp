#pragma once
/// Recognises hands in another coordinate convention than T's. Private to track.

#include <optional>

#include "prostm/track/hand_json.hpp"

namespace prostm {

/// Checks that −z of the joints' frames lies along the bones, and that the index finger is on the
/// thumb's side for the hand's stated side. If not, the words name the convention that fits:
/// another order of the quaternions, mirrored or exchanged axes, exchanged sides.
/// @pre bones longer than 0, unit quaternions.
std::optional<HandProblem> convention_problem(const Hand& hand);

}  // namespace prostm
