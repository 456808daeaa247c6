#pragma once
/// The search for a level in one scene with one method: a procedure of its task, in the
/// setting's own unit.

#include <cstddef>
#include <cstdint>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/procedures.hpp"

namespace prostm {

/// How long a track has stood at an end of its range.
struct AtBound {
  int answers = 0;   ///< in a row at this end, each of which asked for a level beyond it
  bool low = false;  ///< the low end
};

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
  /// The last answers, as far as they asked for a level beyond the same end of the range. Of
  /// adjustments: those accepted there.
  AtBound at_bound() const { return at_bound_; }
  bool is_done() const;
  std::size_t most() const;  ///< trials that it can have
  /// The threshold, or the mean of adjustments; NaN before there is any.
  double result() const;

 private:
  double presented(double level);
  void settle();  // the level after something changed
  void count_at_bound(double level, bool down, bool up);

  LevelSettings settings_;
  PipelineSettings base_;  // that levels are set in
  Procedure procedure_;
  std::size_t answers_ = 0, most_ = 0;
  double lowest_, highest_;  // levels that can be presented
  double level_ = 0.0;
  AtBound at_bound_;
};

}  // namespace prostm
