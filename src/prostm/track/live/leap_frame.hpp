#pragma once
/// One frame of the Leap Motion's JSON, protocol version 6, as services send it live and recordings
/// keep it, completed where old services lack bones: (H13) to (H16) of docs/design.md.

#include <cstdint>
#include <string>
#include <string_view>

#include "prostm/track/hand_frame.hpp"

namespace prostm {

class JsonNode;

/// Reads the hands of a frame, in T; `time` is the tracker's own [s], velocities are 0. Left hands
/// may come with left-handed bases, as the original service sends them, or with right-handed ones.
/// @throws InputError that names the member: it is missing or not a number, a position is farther
/// than 1 m from the tracker, no hand has such radii or bone lengths, there are more than 2 hands,
/// or a hand lacks one of its five fingers.
HandFrame leap_frame(const JsonNode& node);

enum class LeapMessage : std::uint8_t {
  Frame,   ///< a frame, with or without hands
  Other,   ///< the greeting with the version, or an event of the device
  Refused  ///< not JSON, or a frame that leap_frame() refuses, or two hands of the same id and side
};

/// Reads one message. Sets `frame` if the message is a frame, and `problem` to a sentence if it is
/// refused.
LeapMessage leap_message(std::string_view text, HandFrame& frame, std::string& problem);

}  // namespace prostm
