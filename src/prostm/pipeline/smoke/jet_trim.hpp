#pragma once
/// The stage between contact and scene: what the hand gets from each jet sets how hard it blows.

#include <span>
#include <vector>

#include "prostm/core/settings.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm {

/// Where jets blow.
enum class JetPlace : std::uint8_t { Array, Hand };
template <>
inline constexpr std::array<std::string_view, 2> kNames<JetPlace> = {"array", "hand"};

struct JetSettings {
  /// over the array's centre, or where the palm is when a hand first comes in
  JetPlace place = JetPlace::Array;
  double trim_rate = 0.3;    ///< K of (F15) [1/s]; 0: no trim
  double trim_limit = 0.35;  ///< a gain is at most so far from 1

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const JetSettings&) const = default;
};

/// Makes the jets of a scene press alike, (F15) of docs/design/scenes.md. Where a jet meets the
/// hand near its edge air escapes and it presses less; four equal plumes would be felt as three. So
/// a generator of stimuli trims itself, which no smoke does: each jet's speed has a gain that grows
/// while the hand gets less from it than the jets' mean, and falls while it gets more:
///
///   g_q ← g_q exp(K Δt (m − p_q)/m), held to 1 ± limit, then scaled so that Σ g_q² is constant;
///
/// p_q is the largest target pressure nearer to jet q than to any other, m their mean. Gains are
/// held while a jet has no skin above it.
class JetTrim {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  JetTrim(const JetSettings& settings, std::size_t jets);

  /// @param jets as they blow now, in D.  @param dt since the last call [s].
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
