#pragma once
/// Feedback from contact to scene: adjusts the speed of each jet by the pressure that it exerts on
/// the hand.

#include <span>
#include <vector>

#include "prostm/core/settings.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Position of the jets.
enum class JetPlace : std::uint8_t { Array, Hand };
template <>
inline constexpr std::array<std::string_view, 2> kNames<JetPlace> = {"array", "hand"};

struct JetSettings {
  /// over the array's centre, or under the palm at the position where a hand first appears
  JetPlace place = JetPlace::Array;
  double trim_rate = 0.3;    ///< K of (F15) [1/s]; 0: no trim
  double trim_limit = 0.35;  ///< largest distance of a gain from 1

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const JetSettings&) const = default;
};

/// Equalises the pressures of a scene's jets, (F15) of docs/design/scenes.md. A jet near the edge
/// of the hand presses less because air escapes; four equal plumes would be felt as three. Unlike
/// real smoke, the scene corrects this: each jet's speed has a gain that grows while the jet
/// presses less than the jets' mean, and falls while it presses more:
///
///   g_q ← g_q exp(K Δt (m − p_q)/m), clamped to 1 ± limit, then scaled so that Σ g_q² is constant;
///
/// p_q is the largest target pressure among points nearer to jet q than to any other, and m the
/// mean of the p_q. Gains are constant while a jet has no skin above it.
class JetTrim {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  JetTrim(const JetSettings& settings, std::size_t jets);

  /// @param jets current jets, in D. @param dt since the last call [s].
  /// @return whether the gains changed.
  bool update(const TargetFrame& target, std::span<const SmokeJet> jets, double dt) noexcept;

  /// Factors on the jets' speeds.
  std::span<const double> gains() const { return gains_; }
  void set_gains(std::span<const double> gains) { gains_.assign(gains.begin(), gains.end()); }

 private:
  JetSettings settings_;
  std::vector<double> gains_, pressed_;
};

}  // namespace prostm
