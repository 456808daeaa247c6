#pragma once
/// Hands for tests of tracks.

#include "prostm/track/hand_frame.hpp"

namespace prostm::test {

/// Returns a hand with its palm at p and the other joints along x; its reported velocity is wrong
/// and must not be used.
inline Hand hand_at(std::int64_t id, const Vec3& p, Side side = Side::Right) {
  Hand hand;
  hand.id = id;
  hand.side = side;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    hand.position[j] = p + 0.001 * static_cast<double>(j) * Vec3::UnitX();
    hand.orientation[j] = Quat::Identity();
    hand.radius[j] = 0.01;
    hand.velocity[j] = Vec3::Constant(1e9);
  }
  return hand;
}

}  // namespace prostm::test
