#pragma once
/// Checks shared by all readers of hands.

#include <functional>
#include <optional>
#include <string>

#include "prostm/core/text/json.hpp"
#include "prostm/track/hand_faults.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

struct HandProblem {
  HandFault fault;
  std::string words;  ///< the predicate of a sentence about the hand
};

/// Finds what is wrong with a hand: radii (3 to 40 mm), distances between joints (bones 8 to 120
/// mm), orientations that do not follow the bones, joints of the other side's hand. Bends do not
/// matter. @pre finite numbers, unit quaternions.
std::optional<HandProblem> hand_problem(const Hand& hand);

/// Whether a hand seems to be recorded with z up: in front of the tracker, not above it, with its
/// palm towards −z. A tracker sees only hands above it.
bool looks_z_up(const Hand& hand);

/// @throws HandError always, with the node's place in the document.
[[noreturn]] void fail_as(HandFault fault, const JsonNode& node, const std::string& problem);

/// Returns the member "hands" of a frame. @throws HandError unless it is an array.
JsonNode hands_of(const JsonNode& frame);

/// Reads the hands of a frame one by one with `read`, and checks them with hand_problem(). A hand
/// with a fault is dropped and counted; so are a second hand of the same id and side, and all but
/// two hands. The hands that fit the previous frame best are kept.
/// @param before the previous frame, or null.
void read_hands(const JsonNode& hands, const std::function<Hand(const JsonNode&)>& read,
                const HandFrame* before, HandFaults& faults, HandFrame& frame);

}  // namespace prostm
