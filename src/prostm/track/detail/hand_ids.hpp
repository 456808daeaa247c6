#pragma once
/// Ids that stay with the hands of a recording. Private to track.

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// Gives a hand that was renamed from one frame to another its first id back: some trackers count
/// their hands anew in every frame, and a hand of one frame has no velocity. A hand with a new id
/// goes on as the nearest one of its side that the frame does not have, if it was there within
/// `max_gap` and could have come from its place at `max_speed`. Looks back alone, so that it may be
/// done before a recording stands in for a tracker.
/// @throws std::invalid_argument when all the same no hand is in two frames within `max_gap`.
void keep_ids(HandRecording& recording, const TrackSettings& settings);

}  // namespace prostm
