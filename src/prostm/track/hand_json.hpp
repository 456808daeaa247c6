#pragma once
/// Checks shared by all readers of hands.

#include <string>

#include "prostm/core/json.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// Says what is wrong with a hand's radii (3 to 40 mm) or bone lengths (8 to 120 mm), as the
/// predicate of a sentence about the hand; empty if nothing is wrong. @pre finite numbers.
std::string hand_problem(const Hand& hand);

/// Applies hand_problem() to a hand read from `node`. @throws InputError.
void check_hand(const JsonNode& node, const Hand& hand);

/// @throws InputError when two hands of a frame have the same id and side.
void check_ids(const JsonNode& node, const HandFrame& frame);

/// Returns the member "hands" of a frame. @throws InputError unless it is an array of at most 2.
JsonNode hands_of(const JsonNode& frame);

}  // namespace prostm
