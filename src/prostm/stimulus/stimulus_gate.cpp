#include "prostm/stimulus/stimulus_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/text/number_text.hpp"
#include "prostm/track/palm.hpp"

namespace prostm {
namespace {

using B = GateBounds;
using P = GateProblem;

/// Returns the first problem of the hand.
GateFinding look_at(const HandFrame& hands, const ScenePlace& place) {
  if (hands.hands.empty()) return {P::NoHand};
  if (hands.hands.size() > 1) return {P::TwoHands};
  const Palm palm = palm_of(hands.hands.front());
  const double speed = hands.hands.front().velocity[kPalm].norm();
  const Vec2 away = palm.centre.head<2>() - place.centre;
  if (palm.straightness < B::kStraight) return {P::Bent, palm.straightness, B::kStraight};
  if (palm.tilt > B::kTilt) return {P::Tilted, palm.tilt, B::kTilt};
  if (away.norm() > B::kBeside) return {P::Beside, away.norm(), B::kBeside, away};
  if (palm.centre.z() < B::kLow) return {P::Low, palm.centre.z(), B::kLow};
  if (palm.centre.z() > B::kHigh) return {P::High, palm.centre.z(), B::kHigh};
  if (speed > B::kSpeed) return {P::Moving, speed, B::kSpeed};
  return {};
}

/// Returns the first problem of the field.
GateFinding look_at(const FieldShape& shape, const Stimulus& wanted) {
  if (wanted.maxima == 0) return {};
  if (shape.count() != wanted.maxima)
    return {P::Maxima, static_cast<double>(shape.count()), static_cast<double>(wanted.maxima)};
  if (shape.balance < B::kBalance) return {P::Balance, shape.balance, B::kBalance};
  if (shape.saddle > B::kSaddle) return {P::Saddle, shape.saddle, B::kSaddle};
  if (wanted.area > 0.0 && std::abs(shape.area - wanted.area) > wanted.area_margin)
    return {P::Area, shape.area, wanted.area};
  if (wanted.force > 0.0 && std::abs(shape.force - wanted.force) > B::kForce * wanted.force)
    return {P::Force, shape.force, wanted.force};
  return {};
}

/// Returns a finding's value and bound, times `scale`.
ComparedText compared(const GateFinding& f, double scale, int decimals = 0) {
  return compared_text(scale * f.value, scale * f.wanted, decimals);
}

/// Returns where to move a palm that is `away` from the jets, e.g. "30 mm to the left and 12 mm
/// towards you".
std::string way_back(const Vec2& away) {
  constexpr double kLeast = 0.005;  // shorter distances are omitted [m]
  const double x = 1e3 * away.x(), y = 1e3 * away.y();
  const std::string aside =
      fmt::format("{:.0f} mm to the {}", std::abs(x), x > 0.0 ? "left" : "right");
  const std::string along =
      fmt::format("{:.0f} mm {}", std::abs(y), y > 0.0 ? "towards you" : "away from you");
  if (std::abs(away.y()) < kLeast) return aside;
  if (std::abs(away.x()) < kLeast) return along;
  return aside + " and " + along;
}

/// Returns advice about the hand; empty if the problem is one of the field.
std::string hand_sentence(const GateFinding& f) {
  switch (f.problem) {
    case P::NoHand:
      return "There is no hand: hold one flat over the array, palm towards it.";
    case P::TwoHands:
      return "There are two hands: take one away.";
    case P::Bent: {
      const auto [value, bound] = compared(f, 100.0);
      return fmt::format("Stretch the fingers: one is bent to {} % of its length (at least {} %).",
                         value, bound);
    }
    case P::Tilted: {
      const auto [value, bound] = compared(f, 180.0 / kPi);
      return fmt::format("Hold the palm level: it is tilted by {}° (at most {}°).", value, bound);
    }
    case P::Beside:
      return fmt::format("Move the hand {}: it is beside the jets.", way_back(f.away));
    case P::Low:
    case P::High: {
      const bool low = f.problem == P::Low;
      const auto [value, bound] = compared(f, 1e3);
      return fmt::format("{} the hand: the palm is {} mm above the array (at {} {} mm).",
                         low ? "Lift" : "Lower", value, low ? "least" : "most", bound);
    }
    case P::Moving: {
      const auto [value, bound] = compared(f, 1.0, 2);
      return fmt::format("Hold the hand still: it moves at {} m/s (at most {} m/s).", value, bound);
    }
    default:
      return {};
  }
}

/// Returns advice about the field; empty if there is no such problem.
std::string field_sentence(const GateFinding& f) {
  switch (f.problem) {
    case P::Maxima:
      return fmt::format(
          "Wait a second: there are {:.0f} places of pressure, not {:.0f}. If this persists, "
          "centre the jets under the hand.",
          f.value, f.wanted);
    case P::Balance: {
      const auto [value, bound] = compared(f, 100.0);
      return fmt::format(
          "Wait a second: the weakest place of pressure has {} % of the strongest (at least {} %). "
          "If this persists, centre the jets under the hand.",
          value, bound);
    }
    case P::Saddle: {
      const auto [value, bound] = compared(f, 100.0);
      return fmt::format(
          "The places of pressure blur into each other: the valley between two has {} % of the "
          "strongest (at most {} %). Hold the hand flat, or lower it.",
          value, bound);
    }
    case P::Area: {
      const auto [value, bound] = compared(f, 1e4);
      return fmt::format(
          "The pressure covers {} cm², not {}: {}.", value, bound,
          f.value > f.wanted ? "lower the hand" : "lift the hand, or centre the jets");
    }
    case P::Force: {
      const auto [value, bound] = compared(f, 1e3, 2);
      return fmt::format(
          "The total force is {} mN, not {}: centre the jets under the hand, or wait a second.",
          value, bound);
    }
    default:
      return {};
  }
}

}  // namespace

std::string sentence(const GateResult& result) {
  if (result.pass)
    return fmt::format("The stimulus is ready: {} {} of pressure, {:.0f} cm², {:.2f} mN.",
                       result.shape.count(), result.shape.count() == 1 ? "place" : "places",
                       1e4 * result.shape.area, 1e3 * result.shape.force);
  const std::string of_hand = hand_sentence(result.finding);
  if (!of_hand.empty()) return of_hand;
  const std::string of_field = field_sentence(result.finding);
  if (!of_field.empty()) return of_field;
  return fmt::format(
      "Wait: the stimulus was right for {:.0f} % of the last second (at least {:.0f} %).",
      100.0 * result.share, 100.0 * B::kShare);
}

StimulusGate::StimulusGate(int updates, std::size_t max_cells)
    : meter_(max_cells), good_(static_cast<std::size_t>(std::max(1, updates)), 0) {}

GateResult StimulusGate::judge(const HandFrame& hands, const TargetFrame& target,
                               const PlacedStimulus& stimulus) {
  GateResult out;
  if (!target.patches.empty()) out.shape = meter_.measure(target.patches.front());
  out.finding = look_at(hands, stimulus.place);
  const bool held = out.finding.problem == P::None;
  if (held) out.finding = look_at(out.shape, stimulus.wanted);
  good_[next_] = out.finding.problem == P::None ? 1 : 0;
  next_ = (next_ + 1) % good_.size();
  out.share = static_cast<double>(std::count(good_.begin(), good_.end(), 1)) /
              static_cast<double>(good_.size());
  out.pass = held && out.share >= B::kShare;
  return out;
}

}  // namespace prostm
