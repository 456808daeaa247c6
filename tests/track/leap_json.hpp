#pragma once
/// Hands in the messages of a Leap service: protocol version 6 with every bone.

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/track/hand_frame.hpp"

namespace prostm::test {

inline nlohmann::json mm_json(const Vec3& p) {
  return {1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()};
}
inline nlohmann::json axis_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Returns rows x, y, z of a joint's frame; `mirrored` as in the original service for left hands.
inline nlohmann::json basis_json(const Quat& q, bool mirrored) {
  return {axis_json((mirrored ? -1.0 : 1.0) * (q * Vec3::UnitX())), axis_json(q * Vec3::UnitY()),
          axis_json(q * Vec3::UnitZ())};
}

/// Returns one message. `mirrored`: bases of left hands are left-handed.
inline nlohmann::json leap_json(const HandFrame& frame, bool mirrored = true) {
  using nlohmann::json;
  json hands = json::array(), pointables = json::array();
  for (const Hand& hand : frame.hands) {
    const bool left = hand.side == Side::Left;
    const Quat& palm = hand.orientation[kWrist];
    hands.push_back({{"id", hand.id},
                     {"type", left ? "left" : "right"},
                     {"confidence", hand.confidence},
                     {"palmPosition", mm_json(hand.position[kPalm])},
                     {"palmNormal", axis_json(palm * -Vec3::UnitY())},
                     {"direction", axis_json(palm * -Vec3::UnitZ())},
                     {"wrist", mm_json(hand.position[kWrist])},
                     {"armWidth", 1e3 * hand.radius[kWrist] / 0.31}});
    for (int f = 0; f < 5; ++f) {
      // the thumb's metacarpal has no length
      const auto first =
          static_cast<std::size_t>(f == 0 ? kThumbMetacarpal : kIndexMetacarpal + 5 * (f - 1));
      const auto joint = [&](std::size_t bone) {
        return f > 0 ? first + bone : first + (bone == 0 ? 0 : bone - 1);
      };
      json bases = json::array();
      for (std::size_t bone = 0; bone < 4; ++bone)
        bases.push_back(basis_json(hand.orientation[joint(bone)], left && mirrored));
      pointables.push_back({{"id", 10 * hand.id + f},
                            {"handId", hand.id},
                            {"type", f},
                            {"tool", false},
                            {"carpPosition", mm_json(hand.position[joint(0)])},
                            {"mcpPosition", mm_json(hand.position[joint(1)])},
                            {"pipPosition", mm_json(hand.position[joint(2)])},
                            {"dipPosition", mm_json(hand.position[joint(3)])},
                            {"btipPosition", mm_json(hand.position[joint(4)])},
                            {"width", 2e3 * hand.radius[joint(2)]},
                            {"bases", bases}});
    }
  }
  return {{"id", std::llround(frame.time * 110)},
          {"timestamp", std::llround(1e6 * frame.time) + 20'000'000'000},
          {"currentFrameRate", 110},
          {"hands", hands},
          {"pointables", pointables}};
}

}  // namespace prostm::test
