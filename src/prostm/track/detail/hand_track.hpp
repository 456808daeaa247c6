#pragma once
/// One tracked hand at the times of its frames, interpolated between and held after them. Private
/// to track.

#include <cstddef>
#include <vector>

#include "prostm/track/hand_source.hpp"

namespace prostm {

struct HandTrack {
  std::vector<double> times;  ///< strictly increasing [s]
  std::vector<Hand> hands;    ///< one per time; their velocities are not used
};

/// Computes the hand at time t: positions and radii linear between frames i and i + 1, orientations
/// by slerp, and velocities by (H1) of docs/design/hands.md. The hand's last frame is held, with
/// its velocity, when i is the last one.
/// @pre times[i] <= t, and t <= times[i + 1] if that exists. Allocates nothing.
void sample_track(const HandTrack& track, std::size_t i, double t, const TrackSettings& settings,
                  Hand& out) noexcept;

/// Scales v down to length `longest` when it is longer.
void clamp_length(double longest, Vec3& v) noexcept;

}  // namespace prostm
