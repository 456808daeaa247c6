#pragma once
/// The gate of a study: checks whether a held hand receives the intended stimulus of the scene, and
/// what to change if it does not.

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

/// Reasons why a stimulus differs from the intended one, those of the hand first.
enum class GateProblem : std::uint8_t {
  None,
  NoHand,
  TwoHands,
  Bent,     ///< a finger is bent
  Tilted,   ///< the palm is tilted
  Beside,   ///< the palm is beside the jets
  Low,      ///< the palm is too low
  High,     ///< the palm is too high
  Moving,   ///< the palm moves
  Maxima,   ///< wrong number of maxima
  Balance,  ///< maxima of different strength
  Saddle,   ///< maxima that blur into each other
  Area,     ///< wrong area of pressure
  Force     ///< wrong total force
};
template <>
inline constexpr std::array<std::string_view, 14> kNames<GateProblem> = {
    "none", "no-hand", "two-hands", "bent",    "tilted", "beside", "low",
    "high", "moving",  "maxima",    "balance", "saddle", "area",   "force"};

/// The first problem of a frame, with its numbers.
struct GateFinding {
  GateProblem problem = GateProblem::None;
  double value = 0.0;        ///< measured value, in SI; a count for Maxima
  double wanted = 0.0;       ///< violated bound, or intended value of the scene
  Vec2 away = Vec2::Zero();  ///< for Beside: the palm's position from the jets, in D [m]
};

struct GateResult {
  bool pass = false;
  /// share of frames without problem in the last second
  double share = 0.0;
  GateFinding finding;  ///< first problem of this frame
  FieldShape shape;     ///< shape of this frame's target
};

/// Returns whether the hand has no problem, whatever the field is.
inline bool is_held(const GateResult& result) {
  return result.finding.problem == GateProblem::None ||
         result.finding.problem >= GateProblem::Maxima;
}

/// Returns a sentence: what to do, or, for a pass, the measured stimulus.
std::string sentence(const GateResult& result);

/// Bounds for a hand and its target.
struct GateBounds {
  static constexpr double kStraight = 0.90;            ///< least straightness of a finger
  static constexpr double kTilt = 15.0 * kPi / 180.0;  ///< largest tilt of the palm [rad]
  static constexpr double kBeside = 0.025;             ///< largest distance from the jets [m]
  static constexpr double kLow = 0.13,
                          kHigh = 0.26;    ///< height of the palm joint over the array [m]
  static constexpr double kSpeed = 0.05;   ///< largest speed of the palm joint [m/s]
  static constexpr double kBalance = 0.8;  ///< lower bound of the least maximum over the largest
  static constexpr double kSaddle = 0.7;   ///< upper bound of the saddle over the largest pressure
  static constexpr double kForce = 0.10;   ///< largest relative difference from the scene's force
  static constexpr double kShare = 0.8;    ///< least share of frames without problem
};

/// Checks one update after another. Allocates nothing for targets of at most `max_cells`.
class StimulusGate {
 public:
  /// @param updates number of updates per second, over which GateResult::share is computed.
  StimulusGate(int updates, std::size_t max_cells);

  GateResult judge(const HandFrame& hands, const TargetFrame& target,
                   const PlacedStimulus& stimulus);

 private:
  FieldShapeMeter meter_;
  std::vector<std::uint8_t> good_;  // ring buffer: whether each of the last frames has no problem
  std::size_t next_ = 0;
};

}  // namespace prostm
