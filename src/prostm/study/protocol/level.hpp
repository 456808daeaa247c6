#pragma once
/// The setting that a study varies, and how its levels are asked for: [level] of a protocol.

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
  Log  ///< steps are shares of the level
};
template <>
inline constexpr std::array<std::string_view, 2> kNames<LevelScale> = {"linear", "log"};

/// [level]. Levels are in the setting's unit.
struct LevelSettings {
  std::string setting;  ///< "plan.gain"
  double low = 0.0, high = 0.0;
  LevelScale scale = LevelScale::Linear;
  double start = 0.0;      ///< of a staircase; where it is not given: high, or the middle for bayes
  double step = 0.0;       ///< in the setting's unit, or a share of the level
  double reference = 0.0;  ///< the standard's level
  std::string against;     ///< the method that is the standard; empty: the same one at `reference`
  Staircase procedure = Staircase::UpDown;
  double share = 0.75;    ///< of answers for the level, to which up-down converges
  int coarse = 2;         ///< reversals of up-down with the double step
  int reversals = 12;     ///< after which it ends
  int trials = 60;        ///< of a staircase of bayes; at most, of up-down
  double slope = 0.0;     ///< of bayes, per unit of the scale; 0: 20 over the range
  int tracks = 1;         ///< staircases of each scene with each method
  double interval = 2.0;  ///< of a stimulus [s]
  double gap = 1.0;       ///< silence between intervals, at least [s]

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);

  /// The levels as procedures see them: themselves, or their logarithms.
  double to_scale(double level) const;
  double from_scale(double x) const;
  LevelRange range() const { return {to_scale(low), to_scale(high)}; }
  double step_on_scale() const;
};

/// Sets the setting to a level, the nearest whole number where it has whole numbers, and returns
/// what it was set to. @throws std::invalid_argument: there is no such setting among those that can
/// change during a trial ([plan], [am] and [emit]), it is no number, or the level is out of its
/// bounds.
double set_level(PipelineSettings& settings, const std::string& setting, double level);

}  // namespace prostm
