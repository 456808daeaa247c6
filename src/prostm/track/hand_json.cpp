#include "prostm/track/hand_json.hpp"

#include <fmt/format.h>

#include "prostm/core/number_text.hpp"

namespace prostm {
namespace {

constexpr double kMinRadius = 0.003, kMaxRadius = 0.040;  // [m]
constexpr double kMinBone = 0.008, kMaxBone = 0.120;      // [m]

/// A length outside its bounds, in mm, with as many digits as tell it from the bound that it
/// misses.
std::string outside(double length, double least, double most) {
  return compared_text(1e3 * length, 1e3 * (length < least ? least : most), 1).value;
}

}  // namespace

std::string hand_problem(const Hand& hand) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (hand.radius[j] >= kMinRadius && hand.radius[j] <= kMaxRadius) continue;
    return fmt::format("has a radius of {} mm at joint {}; radii must be from 3 to 40 mm",
                       outside(hand.radius[j], kMinRadius, kMaxRadius),
                       joint_name(static_cast<int>(j)));
  }
  for (int j = kThumbMetacarpal; j + 1 < kJointCount; ++j) {
    if (j == kThumbTip || j == kIndexTip || j == kMiddleTip || j == kRingTip) continue;
    const auto from = static_cast<std::size_t>(j);
    const double length = (hand.position[from + 1] - hand.position[from]).norm();
    if (length >= kMinBone && length <= kMaxBone) continue;
    return fmt::format("has a bone of {} mm from {} to {}; bones must be from 8 to 120 mm long",
                       outside(length, kMinBone, kMaxBone), joint_name(j), joint_name(j + 1));
  }
  return {};
}

void check_hand(const JsonNode& node, const Hand& hand) {
  if (const std::string problem = hand_problem(hand); !problem.empty()) node.fail(problem);
}

void check_ids(const JsonNode& node, const HandFrame& frame) {
  if (frame.hands.size() == 2 && frame.hands[0].id == frame.hands[1].id &&
      frame.hands[0].side == frame.hands[1].side) {
    node.fail(fmt::format("has two hands of id {} and the same side; ids must differ",
                          frame.hands[0].id));
  }
}

JsonNode hands_of(const JsonNode& frame) {
  JsonNode hands = frame.at("hands", "an array of at most 2 hands");
  if (hands.array_size() > 2)
    hands.fail(fmt::format("has {} hands; it must have at most 2", hands.array_size()));
  return hands;
}

}  // namespace prostm
