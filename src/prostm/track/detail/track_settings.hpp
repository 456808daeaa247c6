#pragma once
/// Validation of the settings and recordings of hand sources. Private to track.

#include "prostm/track/hand_source.hpp"

namespace prostm {

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bounds.
void validate(const TrackSettings& settings);
void validate(const ScriptedHandSettings& settings);
void validate(const StudyHandSettings& settings);
/// @throws std::invalid_argument for no frames, times that do not increase from 0, or two hands of
/// the same id and side in a frame.
void validate_recording(const HandRecording& recording);
/// Removes hands with a confidence below `least_confidence`. @throws std::invalid_argument with a
/// sentence if there were hands and all are removed.
void leave_out_unsure(const TrackSettings& settings, HandRecording& recording);
/// Returns the settings with a max_gap of at least two usual frame intervals of the recording, for
/// recordings of at least 11 Hz: some are thinned out. @throws std::invalid_argument as validate().
TrackSettings with_gap_for(const HandRecording& recording, const TrackSettings& settings);
void validate_step(double step);  ///< time between samples [s]

/// Hands of a recording before and after a seek are different hands: their ids differ by this.
inline constexpr std::int64_t kIdsPerSeek = 1'000'000;

}  // namespace prostm
