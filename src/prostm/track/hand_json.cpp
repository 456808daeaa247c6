#include "prostm/track/hand_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "prostm/core/text/number_text.hpp"
#include "prostm/track/detail/hand_convention.hpp"

namespace prostm {
namespace {

constexpr double kMinRadius = 0.003, kMaxRadius = 0.040;  // [m]
constexpr double kMinBone = 0.008, kMaxBone = 0.120;      // [m]

/// Returns a length outside its bounds [mm], with enough digits to tell it from the violated bound.
std::string outside(double length, double least, double most) {
  return compared_text(1e3 * length, 1e3 * (length < least ? least : most), 1).value;
}

/// Whether a joint is the last of its finger.
bool is_tip(int j) {
  return j == kThumbTip || j == kIndexTip || j == kMiddleTip || j == kRingTip || j == kLittleTip;
}

std::optional<HandProblem> problem_of_distance(const Hand& hand, int from, int to, double least) {
  const double length =
      (hand.position[static_cast<std::size_t>(to)] - hand.position[static_cast<std::size_t>(from)])
          .norm();
  if (length >= least && length <= kMaxBone) return {};
  if (least > 0.0) {
    return HandProblem{
        HandFault::Bones,
        fmt::format("has a bone of {} mm from {} to {}; bones must be from 8 to 120 mm long",
                    outside(length, least, kMaxBone), joint_name(from), joint_name(to))};
  }
  return HandProblem{HandFault::Bones, fmt::format("has {} mm from {} to {}; it must be at "
                                                   "most 120 mm",
                                                   outside(length, least, kMaxBone),
                                                   joint_name(from), joint_name(to))};
}

std::optional<HandProblem> problem_of_lengths(const Hand& hand) {
  for (int j = kThumbMetacarpal; j < kLittleTip; ++j) {
    if (is_tip(j)) continue;
    if (auto problem = problem_of_distance(hand, j, j + 1, kMinBone)) return problem;
  }
  for (const int j : {kIndexMetacarpal, kMiddleMetacarpal, kLittleMetacarpal}) {
    if (auto problem = problem_of_distance(hand, kWrist, j, 0.0)) return problem;
  }
  return problem_of_distance(hand, kPalm, kMiddleProximal, 0.0);
}

/// A hand that was read, and where.
struct ReadHand {
  Hand hand;
  JsonNode node;
};

bool same(const Hand& a, const Hand& b) {
  return a.id == b.id && a.side == b.side;
}

/// Returns the hand of the same id and side in the previous frame, or null.
const Hand* known(const HandFrame* before, const Hand& hand) {
  if (before == nullptr) return nullptr;
  const auto found = std::find_if(before->hands.begin(), before->hands.end(),
                                  [&](const Hand& other) { return same(other, hand); });
  return found == before->hands.end() ? nullptr : &*found;
}

/// Returns how far a hand moved since the previous frame [m]; 0 if it was not in that frame.
double moved(const HandFrame* before, const Hand& hand) {
  const Hand* was = known(before, hand);
  return was == nullptr ? 0.0 : (hand.position[kPalm] - was->position[kPalm]).norm();
}

void drop(const ReadHand& read, HandFault fault, const std::string& problem, HandFaults& faults) {
  try {
    read.node.fail(problem);
  } catch (const InputError& error) {
    faults.add(fault, error.what());
  }
}

/// Keeps the one that moved less of two hands with the same id and side.
void drop_doubles(const HandFrame* before, std::vector<ReadHand>& hands, HandFaults& faults) {
  for (std::size_t a = 0; a < hands.size(); ++a) {
    for (std::size_t b = a + 1; b < hands.size();) {
      if (!same(hands[a].hand, hands[b].hand)) {
        ++b;
        continue;
      }
      if (moved(before, hands[b].hand) < moved(before, hands[a].hand))
        std::swap(hands[a], hands[b]);
      drop(hands[b], HandFault::Twice,
           fmt::format("has the id {} and side of another hand of its frame; ids must differ",
                       hands[b].hand.id),
           faults);
      hands.erase(hands.begin() + static_cast<std::ptrdiff_t>(b));
    }
  }
}

}  // namespace

std::optional<HandProblem> hand_problem(const Hand& hand) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    if (hand.radius[j] >= kMinRadius && hand.radius[j] <= kMaxRadius) continue;
    return HandProblem{
        HandFault::Bones,
        fmt::format("has a radius of {} mm at joint {}; radii must be from 3 to 40 mm",
                    outside(hand.radius[j], kMinRadius, kMaxRadius),
                    joint_name(static_cast<int>(j)))};
  }
  if (auto problem = problem_of_lengths(hand)) return problem;
  return convention_problem(hand);
}

void fail_as(HandFault fault, const JsonNode& node, const std::string& problem) {
  try {
    node.fail(problem);
  } catch (const InputError& error) {
    throw HandError(fault, error.what());
  }
}

JsonNode hands_of(const JsonNode& frame) {
  try {
    const JsonNode hands = frame.at("hands", "an array of at most 2 hands");
    hands.array_size();
    return hands;
  } catch (const InputError& error) {
    throw HandError(HandFault::Unreadable, error.what());
  }
}

void read_hands(const JsonNode& hands, const std::function<Hand(const JsonNode&)>& read,
                const HandFrame* before, HandFaults& faults, HandFrame& frame) {
  std::vector<ReadHand> good;
  for (std::size_t h = 0; h < hands.array_size(); ++h) {
    const JsonNode node = hands.at(h);
    try {
      good.push_back({read(node), node});
      if (const auto problem = hand_problem(good.back().hand)) {
        drop(good.back(), problem->fault, problem->words, faults);
        good.pop_back();
      }
    } catch (const HandError& error) {
      faults.add(error.fault(), error.what());
    } catch (const InputError& error) {
      faults.add(HandFault::Member, error.what());
    }
  }
  drop_doubles(before, good, faults);
  const std::size_t all = good.size();
  if (all > 2) {
    std::stable_partition(good.begin(), good.end(),
                          [&](const ReadHand& one) { return known(before, one.hand) != nullptr; });
  }
  for (; good.size() > 2; good.pop_back()) {
    drop(good.back(), HandFault::Third,
         fmt::format("is one of {} hands of its frame; there must be at most 2", all), faults);
  }
  frame.hands.clear();
  for (const ReadHand& one : good) frame.hands.push_back(one.hand);
}

}  // namespace prostm
