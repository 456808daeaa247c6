#include "prostm/track/detail/hand_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "prostm/track/detail/track_settings.hpp"

namespace prostm {
namespace {

/// Largest motion of a still joint [m]. In a Leap's recordings some joint moves by 50 µm or more
/// between 99 of 100 frames, and by 1.3 mm in any half second; single precision rounds by less than
/// 1 µm.
constexpr double kLeastMotion = 5e-6;

bool same_place(const std::array<Vec3, kJointCount>& a, const std::array<Vec3, kJointCount>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](const Vec3& p, const Vec3& q) {
    return (p - q).squaredNorm() <= kLeastMotion * kLeastMotion;
  });
}

}  // namespace

HandWatch::HandWatch(const TrackSettings& settings) : settings_(settings) {
  validate(settings);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  for (Posture& posture : postures_) {
    posture.since = -kNever;
    posture.position.fill(Vec3::Constant(kNever));
  }
}

/// Returns for each hand of a frame the time since which its joints have not moved.
std::array<double, 2> HandWatch::still_since(const HandFrame& frame) noexcept {
  std::array<Posture*, 2> of_hand{};
  const auto taken = [&](const Posture& posture) {
    return of_hand[0] == &posture || of_hand[1] == &posture;
  };
  for (std::size_t h = 0; h < frame.hands.size(); ++h) {
    const auto found =
        std::find_if(postures_.begin(), postures_.end(), [&](const Posture& posture) {
          return !taken(posture) && same_place(posture.position, frame.hands[h].position);
        });
    if (found != postures_.end()) of_hand[h] = &*found;
  }
  // a hand that moved replaces the newer of the unmatched postures, so that a still hand that is
  // missing from some frames keeps its posture
  for (std::size_t h = 0; h < frame.hands.size(); ++h) {
    if (of_hand[h] != nullptr) continue;
    const bool second =
        taken(postures_[0]) || (!taken(postures_[1]) && postures_[1].since > postures_[0].since);
    of_hand[h] = &postures_[second ? 1 : 0];
    *of_hand[h] = {frame.time, frame.hands[h].position};
  }
  std::array<double, 2> since{};
  for (std::size_t h = 0; h < frame.hands.size(); ++h) since[h] = of_hand[h]->since;
  return since;
}

void HandWatch::check(HandFrame& frame) noexcept {
  const std::array<double, 2> since = still_since(frame);
  bool freezes = false;
  for (std::size_t h = frame.hands.size(); h-- > 0;) {
    const auto hand = frame.hands.begin() + static_cast<std::ptrdiff_t>(h);
    const bool frozen = frame.time - since[h] >= settings_.freeze_time,
               unsure = hand->confidence < settings_.least_confidence;
    if (frozen) frozen_.fetch_add(1, std::memory_order_relaxed);
    if (unsure) unsure_.fetch_add(1, std::memory_order_relaxed);
    freezes = freezes || frozen;
    if (frozen || unsure) frame.hands.erase(hand);
  }
  freezes_.store(freezes, std::memory_order_relaxed);
}

void HandWatch::report(TrackerStatus& status) const {
  status.unsure = unsure_.load(std::memory_order_relaxed);
  status.frozen = frozen_.load(std::memory_order_relaxed);
  if (status.connected && freezes_.load(std::memory_order_relaxed)) {
    status.sentence += fmt::format("; a hand has not moved at all for {} s: the tracker is frozen",
                                   settings_.freeze_time);
  }
  if (status.unsure > 0) {
    status.sentence += fmt::format("; {} hands were ignored: their confidence was below {}",
                                   status.unsure, settings_.least_confidence);
  }
}

}  // namespace prostm
