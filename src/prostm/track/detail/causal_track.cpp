#include "prostm/track/detail/causal_track.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/track/detail/hand_track.hpp"
#include "prostm/track/detail/track_settings.hpp"

namespace prostm {
namespace {

/// Frames with a smaller Σ(t − t̄)² count as simultaneous [s²]: 1 ms or less gives no velocity.
constexpr double kLeastSpread = 5e-7;

bool same(const Hand& a, const Hand& b) {
  return a.id == b.id && a.side == b.side;
}

}  // namespace

CausalTrack::CausalTrack(const TrackSettings& settings) : settings_(settings) {
  validate(settings);
}

void CausalTrack::clear() noexcept {
  any_ = false;
  for (Track& track : tracks_) track.count = 0;
}

bool CausalTrack::add(const HandFrame& frame) noexcept {
  if (any_ && !(frame.time > newest_time_)) return false;
  any_ = true;
  newest_time_ = frame.time;
  for (Track& track : tracks_) {
    if (track.count > 0 && frame.time - track.last_time() > settings_.max_gap) track.count = 0;
  }
  for (const Hand& hand : frame.hands) append(track_of(frame, hand), frame.time, hand);
  return true;
}

/// Returns the hand's own track; else that of a hand of the same side that is missing from the
/// frame, since a tracker that lost a hand gives it a new id; else a free track; else the other
/// hand's.
CausalTrack::Track& CausalTrack::track_of(const HandFrame& frame, const Hand& hand) noexcept {
  for (Track& track : tracks_) {
    if (track.count > 0 && same(track.hand, hand)) return track;
  }
  const auto rank = [&](const Track& track) {
    const bool kept = std::any_of(frame.hands.begin(), frame.hands.end(),
                                  [&](const Hand& other) { return same(other, track.hand); });
    if (track.count == 0) return 1;
    return kept ? 3 : track.hand.side == hand.side ? 0 : 2;
  };
  Track& taken = rank(tracks_[0]) <= rank(tracks_[1]) ? tracks_[0] : tracks_[1];
  taken.count = 0;
  return taken;
}

void CausalTrack::append(Track& track, double time, const Hand& hand) const noexcept {
  track.newest = (track.newest + 1) % kFrames;
  track.count = std::min(track.count + 1, kFrames);
  track.times[track.newest] = time;
  track.positions[track.newest] = hand.position;
  track.hand = hand;
  set_velocities(track);
}

/// (H17): Σ(t − t̄)(x − x̄) / Σ(t − t̄)² over the window, which includes the frame before the
/// newest one even if a slow tracker sent it earlier.
void CausalTrack::set_velocities(Track& track) const noexcept {
  const double newest = track.last_time();
  const auto slot = [&](std::size_t back) { return (track.newest + kFrames - back) % kFrames; };
  std::size_t n = 1;
  while (n < track.count && (n == 1 || newest - track.times[slot(n)] <= settings_.smoothing_time)) {
    ++n;
  }
  double mean = 0.0, spread = 0.0;  // sums over times relative to the newest
  for (std::size_t i = 0; i < n; ++i) mean += (track.times[slot(i)] - newest);
  mean /= static_cast<double>(n);
  track.hand.velocity.fill(Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    const double t = track.times[slot(i)] - newest - mean;
    spread += t * t;
    // Σ(t − t̄) = 0, so x may have any origin; the newest position keeps rounding errors small
    for (std::size_t j = 0; j < kJointCount; ++j) {
      track.hand.velocity[j] += t * (track.positions[slot(i)][j] - track.hand.position[j]);
    }
  }
  for (Vec3& v : track.hand.velocity) {
    v = spread > kLeastSpread ? Vec3(v / spread) : Vec3::Zero();
    clamp_length(settings_.max_speed, v);
  }
}

void CausalTrack::sample(double time, HandFrame& out) const noexcept {
  out.time = time;
  out.age = any_ ? std::max(time - newest_time_, 0.0) : 0.0;
  out.hands.clear();
  for (const Track& track : tracks_) {
    if (track.count == 0 || time - track.last_time() > settings_.max_gap) continue;
    out.hands.push_back(track.hand);
    if (!(settings_.prediction > 0.0)) continue;
    const double horizon = std::max(time - track.last_time(), 0.0) + settings_.prediction;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      Vec3 ahead = horizon * track.hand.velocity[j];
      clamp_length(settings_.prediction_limit, ahead);
      out.hands.back().position[j] += ahead;
    }
  }
}

}  // namespace prostm
