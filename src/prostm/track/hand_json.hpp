#pragma once
/// What readers of hands share: the checks of what no hand can be.

#include <string>

#include "prostm/core/json.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// What is wrong with a hand's radii (3 to 40 mm) or bone lengths (8 to 120 mm), to follow the
/// hand's name in a sentence; empty when nothing is. @pre finite numbers.
std::string hand_problem(const Hand& hand);

/// hand_problem() of a hand that came from `node`. @throws InputError.
void check_hand(const JsonNode& node, const Hand& hand);

/// @throws InputError when two hands of a frame have one id and side.
void check_ids(const JsonNode& node, const HandFrame& frame);

/// The member "hands" of a frame. @throws InputError unless it is an array of at most 2.
JsonNode hands_of(const JsonNode& frame);

}  // namespace prostm
