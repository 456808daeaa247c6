#pragma once
/// The setting that a study varies, and how its levels are chosen: [level] of a protocol.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "prostm/core/settings.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/study/protocol/level_range.hpp"

namespace prostm {

enum class Staircase : std::uint8_t { UpDown, Bayes };
template <>
inline constexpr std::array<std::string_view, 2> kNames<Staircase> = {"up-down", "bayes"};

enum class LevelScale : std::uint8_t {
  Linear,
  Log  ///< steps are proportional to the level
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<LevelScale> = {"linear", "log"};

/// [level]. Levels are in the setting's unit.
struct LevelSettings {
  std::string setting;  ///< "plan.gain"
  double low = 0.0, high = 0.0;
  LevelScale scale = LevelScale::Linear;
  double start = 0.0;      ///< of a staircase; default: high, or the middle for bayes
  double step = 0.0;       ///< in the setting's unit, or a share of the level
  double reference = 0.0;  ///< the standard's level
  std::string against;     ///< the method used as standard; empty: the same method at `reference`
  Staircase procedure = Staircase::UpDown;
  double share = 0.75;    ///< share of answers for the level that up-down converges to
  int coarse = 2;         ///< first reversals of up-down, with the double step
  int reversals = 12;     ///< total reversals, after which it ends
  int trials = 60;        ///< length of a bayes staircase; upper limit for up-down
  double slope = 0.0;     ///< of bayes, per unit of the scale; 0: 20 divided by the range
  int tracks = 1;         ///< staircases for each scene with each method
  double interval = 2.0;  ///< length of a stimulus [s]
  double gap = 1.0;       ///< shortest silence between intervals [s]

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);

  /// The level on the procedures' scale: unchanged, or its logarithm.
  double to_scale(double level) const;
  double from_scale(double x) const;
  LevelRange range() const { return {to_scale(low), to_scale(high)}; }
  double step_on_scale() const;
};

/// Sets the setting to a level, rounded if the setting is a whole number, and returns the value
/// that was set. @throws std::invalid_argument: no such setting among those that can change during
/// a trial ([plan], [am] and [emit]), not a number, or the level is out of bounds.
double set_level(PipelineSettings& settings, const std::string& setting, double level);

}  // namespace prostm
