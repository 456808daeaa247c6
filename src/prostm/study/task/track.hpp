#pragma once
/// The search for a level in one scene with one method, by a procedure of the task, in the
/// setting's own unit.

#include <cstddef>
#include <cstdint>

#include "prostm/study/protocol/protocol.hpp"
#include "prostm/study/task/procedures.hpp"

namespace prostm {

/// Successive answers at an end of the range.
struct AtBound {
  int answers = 0;   ///< successive answers at this end, each of which asked for a level beyond it
  bool low = false;  ///< the low end
};

/// Does not depend on time: the same answers in the same order give the same levels.
class Track {
 public:
  /// @pre the protocol's task has levels. @throws std::invalid_argument: a setting of [level] that
  /// is invalid for its procedure.
  Track(const Protocol& protocol, std::uint64_t seed);

  /// The level to present, rounded to six digits, or to a whole number for integer settings. @pre
  /// !is_done().
  double level() const { return level_; }
  /// Records an answer of a staircase. @param felt whether it was for the level: its interval was
  /// chosen, or yes.
  void answer(bool felt);
  /// Tunes an adjustment. @param steps upwards; negative: downwards.
  void tune(int steps, bool coarse);
  /// Ends an adjustment at a level.
  void accept(double level);
  /// Counts the latest successive answers that asked for a level beyond the same end of the range;
  /// for adjustments, those accepted at that end.
  AtBound at_bound() const { return at_bound_; }
  bool is_done() const;
  std::size_t most() const;  ///< largest number of trials
  /// The threshold, or the mean of adjustments; NaN before the first.
  double result() const;

 private:
  double presented(double level);
  void settle();  // updates the level
  void count_at_bound(double level, bool down, bool up);

  LevelSettings settings_;
  PipelineSettings base_;  // settings in which levels are set
  Procedure procedure_;
  std::size_t answers_ = 0, most_ = 0;
  double lowest_, highest_;  // bounds of the levels that can be presented
  double level_ = 0.0;
  AtBound at_bound_;
};

}  // namespace prostm
