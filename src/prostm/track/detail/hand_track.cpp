#include "prostm/track/detail/hand_track.hpp"

#include <algorithm>

namespace prostm {
namespace {

using Joints = std::array<Vec3, kJointCount>;

/// Computes the mean over [begin, end] of joints that move linearly between frames. @pre begin <
/// end, both within the track.
void mean_joints(const HandTrack& track, double begin, double end, Joints& mean) {
  mean.fill(Vec3::Zero());
  const auto first = std::upper_bound(track.times.begin(), track.times.end(), begin) - 1;
  for (auto k = static_cast<std::size_t>(first - track.times.begin());
       k + 1 < track.times.size() && track.times[k] < end; ++k) {
    // share of this interval, and the weights of its two frames
    const double start = track.times[k], length = track.times[k + 1] - start;
    const double from = std::max(begin, start), to = std::min(end, start + length);
    const double share = (to - from) / (end - begin);
    const double late = 0.5 * ((from - start) + (to - start)) / length;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      mean[j] += share * ((1.0 - late) * track.hands[k].position[j] +
                          late * track.hands[k + 1].position[j]);
    }
  }
}

/// (H1): the difference of two means, one half a window later and one half a window earlier,
/// divided by the time between their centres. Exact for linear motion, also at the ends of the
/// track, where the windows are cut.
void smoothed_velocity(const HandTrack& track, double t, const TrackSettings& settings,
                       Joints& velocity) {
  const double first = track.times.front(), last = track.times.back();
  if (!(last > first)) {
    velocity.fill(Vec3::Zero());
    return;
  }
  const double half = 0.5 * std::min(settings.smoothing_time, 0.5 * (last - first));
  const double before = std::max(t - half, first), after = std::min(t + half, last);
  const double before_begin = std::max(before - half, first),
               before_end = std::min(before + half, last);
  const double after_begin = std::max(after - half, first),
               after_end = std::min(after + half, last);

  Joints mean;
  mean_joints(track, before_begin, before_end, mean);
  mean_joints(track, after_begin, after_end, velocity);
  const double distance = 0.5 * ((after_begin + after_end) - (before_begin + before_end));
  for (std::size_t j = 0; j < kJointCount; ++j) {
    velocity[j] = (velocity[j] - mean[j]) / distance;
    clamp_length(settings.max_speed, velocity[j]);
  }
}

}  // namespace

void clamp_length(double longest, Vec3& v) noexcept {
  const double length = v.norm();
  if (length > longest) v *= longest / length;
}

void sample_track(const HandTrack& track, std::size_t i, double t, const TrackSettings& settings,
                  Hand& out) noexcept {
  out = track.hands[i];
  if (i + 1 < track.times.size()) {
    const Hand& next = track.hands[i + 1];
    const double u =
        std::clamp((t - track.times[i]) / (track.times[i + 1] - track.times[i]), 0.0, 1.0);
    out.confidence += u * (next.confidence - out.confidence);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      out.position[j] += u * (next.position[j] - out.position[j]);
      out.orientation[j] = out.orientation[j].slerp(u, next.orientation[j]).normalized();
      out.radius[j] += u * (next.radius[j] - out.radius[j]);
    }
  }
  smoothed_velocity(track, t, settings, out.velocity);
}

}  // namespace prostm
