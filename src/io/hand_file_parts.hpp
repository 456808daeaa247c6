#pragma once
/// What the readers of hand recordings share. Private to io.

#include "io/json.hpp"
#include "track/hand_source.hpp"

namespace prostm {

/// Farther than any tracker sees [m].
inline constexpr double kMaxHandDistance = 10.0;
/// A recording longer than a day is a mistake in its unit of time [s].
inline constexpr double kMaxRecordingTime = 86400.0;

/// Checks radii (3 to 40 mm) and bone lengths (8 to 120 mm) of a hand that came from `node`.
/// @throws InputError.
void check_hand(const JsonNode& node, const Hand& hand);

/// The member "hands" of a frame. @throws InputError unless it is an array of at most 2.
JsonNode hands_of(const JsonNode& frame);

/// Appends a frame at `time` [s] after the first one. @throws InputError when time does not
/// increase, or when two hands of the frame have one id and side.
void append_frame(const JsonNode& node, double time, HandFrame frame, HandRecording& recording);

/// @throws InputError when the recording `name` is empty.
void require_frames(const HandRecording& recording, const std::string& name);

}  // namespace prostm
