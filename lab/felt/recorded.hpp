#pragma once
/// Live runs on the targets of a recorded run.

#include <string>
#include <vector>

#include "felt/live.hpp"

namespace prostm::bench {

/// Returns sequences of a second from a recording of `prostm run`, evenly spaced over the frames
/// with pressure. Only the first hand of a frame is used. The targets of a sequence are resampled
/// onto one raster, fixed to the hand's plane, with the skin and the plane's pose of the first one.
/// @param most number of sequences, 0: all; there are fewer if the recording is short.
/// @throws InputError as RecordingReader does, and if no second has a hand with pressure in every
/// frame, and a frame for each of its plans.
std::vector<LiveSequence> recorded_sequences(const std::string& path, int most);

}  // namespace prostm::bench
