#pragma once
/// Ids that stay with the hands of a recording. Private to track.

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Restores the first id of a hand whose id changed between frames: some trackers number their
/// hands anew in every frame, and a hand of a single frame has no velocity. A hand with a new id
/// continues the nearest hand of its side that is missing from the frame, if that hand was seen
/// within `max_gap` and could have moved here at `max_speed`. Uses past frames only, so it may be
/// applied before a recording is played in place of a tracker.
/// @throws std::invalid_argument if even then no hand is in two frames within `max_gap`.
void keep_ids(HandRecording& recording, const TrackSettings& settings);

}  // namespace prostm
