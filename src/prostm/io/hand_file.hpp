#pragma once
/// Hand recordings: the neutral JSON Lines format, and Leap Motion recordings as the tracker sent
/// them.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "prostm/track/hand_source.hpp"

namespace prostm {

using ReadProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Reads `.hands.jsonl` (hand-frames/1) or a Leap JSON v6 recording, told apart by their content.
/// Frames without hands are kept.
/// @throws InputError with a sentence that names file, line or frame, and what would be right:
/// wrong joint count, non-finite numbers, time that does not increase, radii or bone lengths that
/// no hand has, no frames.
/// @param progress is told after each frame of a .hands.jsonl how many of its bytes have been read:
/// a long recording takes half a minute.
HandRecording read_hand_recording(const std::string& path, const ReadProgress& progress = {});

/// The two parsers; `name` stands for the file in messages. @throws InputError.
HandRecording hands_from_jsonl(std::string_view text, const std::string& name,
                               const ReadProgress& progress = {});
HandRecording hands_from_leap_json(std::string_view text, const std::string& name);

}  // namespace prostm
