#pragma once
/// The gate of a study: whether a held hand gets what the scene is meant to press on it, and what
/// to change where it does not.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/text/names.hpp"
#include "prostm/core/units.hpp"
#include "prostm/stimulus/stimulus.hpp"
#include "prostm/target/field_shape.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// Reasons why a stimulus is not the scene's, the hand's faults first.
enum class GateProblem : std::uint8_t {
  None,
  NoHand,
  TwoHands,
  Bent,     ///< a finger
  Tilted,   ///< the palm
  Beside,   ///< the palm is beside the jets
  Low,      ///< the palm
  High,     ///< the palm
  Moving,   ///< the palm
  Maxima,   ///< another number of maxima
  Balance,  ///< maxima that are not alike
  Saddle,   ///< maxima that run into each other
  Area,
  Force
};
template <>
inline constexpr std::array<std::string_view, 14> kNames<GateProblem> = {
    "none", "no-hand", "two-hands", "bent",    "tilted", "beside", "low",
    "high", "moving",  "maxima",    "balance", "saddle", "area",   "force"};

/// The first problem of a frame, with its numbers.
struct GateFinding {
  GateProblem problem = GateProblem::None;
  double value = 0.0;        ///< in SI; a count for Maxima
  double wanted = 0.0;       ///< the bound that it passes, or what the scene has
  Vec2 away = Vec2::Zero();  ///< of Beside: the palm from the jets, along D's axes [m]
};

struct GateResult {
  bool pass = false;
  /// share of the last second's frames that have no problem
  double share = 0.0;
  GateFinding finding;  ///< of this frame
  FieldShape shape;     ///< of this frame's target
};

/// Whether nothing is wrong with the hand, whatever the field is.
inline bool is_held(const GateResult& result) {
  return result.finding.problem == GateProblem::None ||
         result.finding.problem >= GateProblem::Maxima;
}

/// Says what to do, in a sentence; for a pass, what was found.
std::string sentence(const GateResult& result);

/// Bounds that a hand and its target must keep.
struct GateBounds {
  static constexpr double kStraight = 0.90;            ///< least straightness of a finger
  static constexpr double kTilt = 15.0 * kPi / 180.0;  ///< largest tilt of the palm [rad]
  static constexpr double kBeside = 0.025;             ///< largest distance from the jets [m]
  static constexpr double kLow = 0.13,
                          kHigh = 0.26;    ///< height of the palm joint over the array [m]
  static constexpr double kSpeed = 0.05;   ///< of the palm joint [m/s]
  static constexpr double kBalance = 0.8;  ///< the least maximum over the largest
  static constexpr double kSaddle = 0.7;   ///< over the largest
  static constexpr double kForce = 0.10;   ///< difference over the scene's
  static constexpr double kShare = 0.8;    ///< least share of good frames
};

/// Judges update after update. Allocates nothing for targets of at most `max_cells`.
class StimulusGate {
 public:
  /// @param updates in a second, over which frames are counted.
  StimulusGate(int updates, std::size_t max_cells);

  GateResult judge(const HandFrame& hands, const TargetFrame& target,
                   const PlacedStimulus& stimulus);

 private:
  FieldShapeMeter meter_;
  std::vector<std::uint8_t> good_;  // a ring: whether each of the last frames has no problem
  std::size_t next_ = 0;
};

}  // namespace prostm
