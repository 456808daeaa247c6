#pragma once
/// The search for a level in one scene with one method: a procedure of staircase.hpp, in the
/// setting's own unit.

#include <cstddef>
#include <cstdint>
#include <variant>

#include "prostm/study/protocol.hpp"

namespace prostm {

/// A state without a clock: the same answers in the same order lead to the same levels.
class Track {
 public:
  /// @pre the protocol's task has levels. @throws std::invalid_argument: a setting of [level] that
  /// its procedure does not take.
  Track(const Protocol& protocol, std::uint64_t seed);

  /// The level that is to be presented, of six digits, or a whole number where the setting has
  /// those. @pre !is_done().
  double level() const { return level_; }
  /// An answer to a staircase's level. @param felt whether it was for the level: its interval was
  /// chosen, or yes.
  void answer(bool felt);
  /// Tunes an adjustment. @param steps up or, below 0, down.
  void tune(int steps, bool coarse);
  /// Ends an adjustment at a level.
  void accept(double level);
  bool is_done() const;
  std::size_t most() const;  ///< trials that it can have
  /// The threshold, or the mean of adjustments; NaN before there is any.
  double result() const;

 private:
  void settle();  // the level after something changed

  LevelSettings settings_;
  PipelineSettings base_;  // that levels are set in
  std::variant<WeightedUpDown, BayesianStaircase, Adjustment> procedure_;
  double level_ = 0.0;
  std::size_t answers_ = 0, most_ = 0;
};

/// Whether guessing makes half of the answers right: two intervals of the same method.
bool has_right_answers(const Protocol& protocol);

}  // namespace prostm
