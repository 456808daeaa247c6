#pragma once
/// One frame of the Leap Motion's JSON, protocol version 6, as services send it and recordings
/// store it. Bones that old services do not send are reconstructed: (H13) to (H16) of
/// docs/design/hands.md.

#include <cstdint>
#include <string_view>

#include "prostm/track/hand_faults.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

class JsonNode;

/// Reads the hands of a frame, in T; `time` is the tracker's own [s], velocities are 0. Left hands
/// may come with left-handed bases, as the original service sends them, or with right-handed ones.
/// Fingers without a type are told apart by their id, ten times the hand's plus the type. A hand is
/// dropped and counted in `faults` if a member is missing or not a number, a position is farther
/// than 1 m from the tracker, a finger is missing, or read_hands() refuses it.
/// @param before the previous frame, or null.
/// @throws HandError if the frame has no time, no list of hands, or hands but no fingers.
HandFrame leap_frame(const JsonNode& node, const HandFrame* before, HandFaults& faults);

/// Whether a JSON document is not a frame but the greeting of a service, or an event of a device.
bool is_leap_news(const JsonNode& node);

enum class LeapMessage : std::uint8_t {
  Frame,   ///< a frame, with or without hands
  Other,   ///< the greeting with the version, or an event of the device
  Refused  ///< not JSON, or a frame that leap_frame() refuses
};

/// Reads one message. Sets `frame` if the message is a frame; on entry it must hold the previous
/// frame. Adds dropped frames and hands to `faults`.
LeapMessage leap_message(std::string_view text, HandFrame& frame, HandFaults& faults);

}  // namespace prostm
