#pragma once
/// The intervals of a trial: what sounds when, once its stimulus has begun.

#include "prostm/study/task/task.hpp"

namespace prostm {

/// Presents the intervals of a plan one after the other, with a gap between two: once, or in turn
/// until the trial ends.
class Intervals {
 public:
  /// The first interval sounds from now on. @param time [s].
  void begin(const IntervalPlan& plan, double time);
  /// @param in_force whether the run plays what shows_level() asks for. @pre begin().
  void look(double time, bool in_force);

  bool sounds() const { return sounds_; }
  /// Whether what sounds, or is next, is the level's.
  bool shows_level() const { return plan_.shows_level[place_]; }
  /// The interval that sounds, from 1; 0 in silence, and where there is only one.
  int interval() const { return sounds_ && several() ? static_cast<int>(place_) + 1 : 0; }
  /// Whether all has been presented that an answer needs.
  bool takes_answer() const { return begun_ >= plan_.shows_level.size(); }
  double asked_at() const { return asked_at_; }  ///< since when it does [s]
  bool is_over() const { return over_; }         ///< nothing sounds any more

 private:
  bool several() const { return plan_.shows_level.size() > 1; }

  IntervalPlan plan_;
  bool sounds_ = false, over_ = false;
  std::size_t place_ = 0;  // of the interval that sounds, or is next
  std::size_t begun_ = 0;  // intervals so far
  double since_ = 0.0, asked_at_ = 0.0;
};

}  // namespace prostm
