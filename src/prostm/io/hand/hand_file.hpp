#pragma once
/// Hand recordings: the neutral JSON Lines format, and recordings of the Leap Motion service.

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "prostm/track/hand_source.hpp"

namespace prostm {

using ReadProgress = std::function<void(std::size_t done, std::size_t all)>;

/// Reads `.hands.jsonl` (hand-frames/1) or a Leap recording, distinguished by content. A Leap
/// recording is a document with "frames" or a list of frames (plain, nested in lists, or packed by
/// LeapJS), or the messages of the service, one per line. Frames without hands are kept.
///
/// Hands with a fault are dropped, as are frames with a fault of their own or with an inconsistent
/// time; HandRecording::reading counts them by cause. @throws InputError naming file, line or
/// frame, and the remedy: more than a quarter of the frames or of the hands would be dropped, no
/// frames, an impossible frame rate, a duration above a day. @param progress called with the number
/// of bytes read after each frame with its own line: a long recording takes half a minute.
HandRecording read_hand_recording(const std::string& path, const ReadProgress& progress = {});

/// The two parsers; `name` is the file's name in messages. @throws InputError.
HandRecording hands_from_jsonl(std::string_view text, const std::string& name,
                               const ReadProgress& progress = {});
HandRecording hands_from_leap_json(std::string_view text, const std::string& name,
                                   const ReadProgress& progress = {});

}  // namespace prostm
