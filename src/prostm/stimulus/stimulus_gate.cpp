#include "prostm/stimulus/stimulus_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/track/palm.hpp"

namespace prostm {
namespace {

using B = GateBounds;
using P = GateProblem;

/// The hand's first problem.
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

/// The field's first problem.
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

/// "30 mm to the left and 12 mm towards you": where a palm must go that is `away` from the jets.
std::string way_back(const Vec2& away) {
  constexpr double kLeast = 0.005;  // a shorter way is not told [m]
  const double x = 1e3 * away.x(), y = 1e3 * away.y();
  const std::string aside =
      fmt::format("{:.0f} mm to the {}", std::abs(x), x > 0.0 ? "left" : "right");
  const std::string along =
      fmt::format("{:.0f} mm {}", std::abs(y), y > 0.0 ? "towards you" : "away from you");
  if (std::abs(away.y()) < kLeast) return aside;
  if (std::abs(away.x()) < kLeast) return along;
  return aside + " and " + along;
}

}  // namespace

std::string sentence(const GateResult& result) {
  if (result.pass)
    return fmt::format("The stimulus is as it should be: {} {} of pressure, {:.0f} cm², {:.2f} mN.",
                       result.shape.count(), result.shape.count() == 1 ? "place" : "places",
                       1e4 * result.shape.area, 1e3 * result.shape.force);
  const GateFinding& f = result.finding;
  switch (f.problem) {
    case P::None:
      break;
    case P::NoHand:
      return "There is no hand: hold one flat over the array, palm towards it.";
    case P::TwoHands:
      return "There are two hands: take one away.";
    case P::Bent:
      return fmt::format("Stretch the fingers: one is bent to {:.0f} % of its length.",
                         100.0 * f.value);
    case P::Tilted:
      return fmt::format("Hold the palm level: it is tilted by {:.0f}°.", f.value * 180.0 / kPi);
    case P::Beside:
      return fmt::format("Move the hand {}: it is beside the jets.", way_back(f.away));
    case P::Low:
    case P::High:
      return fmt::format(
          "{} the hand: the palm is {:.0f} mm above the array, not {:.0f} to {:.0f}.",
          f.problem == P::Low ? "Lift" : "Lower", 1e3 * f.value, 1e3 * B::kLow, 1e3 * B::kHigh);
    case P::Moving:
      return fmt::format("Hold the hand still: it moves at {:.2f} m/s.", f.value);
    case P::Maxima:
      return fmt::format(
          "Wait a second: there are {:.0f} places of pressure, not {:.0f}. If that stays, "
          "centre the jets under the hand.",
          f.value, f.wanted);
    case P::Balance:
      return fmt::format(
          "Wait a second: the weakest place has {:.0f} % of the strongest. If that stays, "
          "centre the jets under the hand.",
          100.0 * f.value);
    case P::Saddle:
      return fmt::format(
          "The places run together: the saddle between two has {:.0f} % of the "
          "strongest. Spread the hand flat, or lower it.",
          100.0 * f.value);
    case P::Area:
      return fmt::format(
          "{:.0f} cm² are pressed, not {:.0f}: {}.", 1e4 * f.value, 1e4 * f.wanted,
          f.value > f.wanted ? "lower the hand" : "lift the hand, or centre the jets");
    case P::Force:
      return fmt::format("The total force is {:.2f} mN, not {:.2f}: {}.", 1e3 * f.value,
                         1e3 * f.wanted, "centre the jets under the hand, or wait a second");
  }
  return fmt::format("Hold on: {:.0f} % of the last second is as it should be.",
                     100.0 * result.share);
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
