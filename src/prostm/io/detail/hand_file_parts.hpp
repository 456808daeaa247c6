#pragma once
/// Code that the readers of hand recordings share. Private to io.

#include "prostm/core/json.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm {

/// A recording longer than a day is a mistake in its unit of time [s].
inline constexpr double kMaxRecordingTime = 86400.0;

/// Appends a frame at `time` [s] after the first one. @throws InputError when time does not
/// increase, or when two hands of the frame have one id and side.
void append_frame(const JsonNode& node, double time, HandFrame frame, HandRecording& recording);

/// @param what the file `name` is: "is a PNG picture, not a hand recording". @throws InputError.
[[noreturn]] void refuse_as_hands(const std::string& name, const std::string& what);

/// @throws InputError when the recording `name` is empty.
void require_frames(const HandRecording& recording, const std::string& name);

}  // namespace prostm
