#pragma once
/// The timing of a trial's intervals, once its stimulus has begun.

#include "prostm/study/task/task.hpp"

namespace prostm {

/// Presents the intervals of a plan one after the other, separated by gaps: once, or repeatedly
/// until the trial ends.
class Intervals {
 public:
  /// Starts the first interval. @param time [s].
  void begin(const IntervalPlan& plan, double time);
  /// @param in_force whether the run already plays the stimulus that shows_level() asks for. @pre
  /// begin().
  void look(double time, bool in_force);

  bool is_playing() const { return playing_; }
  /// Whether the current or next interval presents the level, not the standard.
  bool shows_level() const { return plan_.shows_level[place_]; }
  /// The current interval, from 1; 0 during silence, or if there is only one.
  int interval() const { return playing_ && several() ? static_cast<int>(place_) + 1 : 0; }
  /// Whether an answer can be given: the last interval has begun, or ended if the duration is
  /// fixed.
  bool takes_answer() const {
    return plan_.answer_after ? over_ : begun_ >= plan_.shows_level.size();
  }
  double asked_at() const { return asked_at_; }  ///< when the last interval began [s]
  bool is_over() const { return over_; }         ///< the last interval has ended

 private:
  bool several() const { return plan_.shows_level.size() > 1; }

  IntervalPlan plan_;
  bool playing_ = false, over_ = false;
  std::size_t place_ = 0;  // of the current or next interval
  std::size_t begun_ = 0;  // intervals begun so far
  double since_ = 0.0, asked_at_ = 0.0;
};

}  // namespace prostm
