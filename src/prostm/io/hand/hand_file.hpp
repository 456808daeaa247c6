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

/// Reads `.hands.jsonl` (hand-frames/1) or a Leap recording, told apart by their content. A Leap
/// recording is a document with "frames" or a list of frames, plain, in lists of their own or
/// packed by LeapJS, or the messages of a service, one a line. Frames without hands are kept.
///
/// A hand with a fault is left out of its frame, and a frame with a fault of its own, or a time
/// that does not fit between those around, is left out; HandRecording::reading counts them by
/// cause.
/// @throws InputError with a sentence that names file, line or frame, and what would be right: more
/// than a quarter of the frames or of the hands would be left out, no frames, a frame rate that no
/// tracker has, longer than a day.
/// @param progress is told how many bytes have been read after each frame that has a line of its
/// own: a long recording takes half a minute.
HandRecording read_hand_recording(const std::string& path, const ReadProgress& progress = {});

/// The two parsers; `name` stands for the file in messages. @throws InputError.
HandRecording hands_from_jsonl(std::string_view text, const std::string& name,
                               const ReadProgress& progress = {});
HandRecording hands_from_leap_json(std::string_view text, const std::string& name,
                                   const ReadProgress& progress = {});

}  // namespace prostm
