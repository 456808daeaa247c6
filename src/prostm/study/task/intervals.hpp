#pragma once
/// The intervals of a trial: what sounds when, once its stimulus has begun.

#include "prostm/study/protocol/order.hpp"

namespace prostm {

/// Identification and judgement have one interval; a forced choice has two with a gap; an
/// adjustment has those of the standard and of the level in turn, until it is accepted.
class Intervals {
 public:
  /// Whether the interval that a trial begins with is the level's (or the only one), not the
  /// standard's.
  static bool begins_with_level(const Protocol& protocol, const Trial& trial);

  /// The first interval sounds from now on. @param time [s].
  void begin(const Protocol& protocol, const Trial& trial, double time);
  /// @param in_force whether the run plays what shows_level() asks for. @pre begin().
  void look(double time, bool in_force);

  bool sounds() const { return sounds_; }
  /// Whether what sounds, or is next, is the level's.
  bool shows_level() const { return shows_level_; }
  /// The interval that sounds, 1 or 2; 0 in silence, and where there is only one.
  int interval() const { return sounds_ && several_ ? 1 + (number_ - 1) % 2 : 0; }
  /// Whether all has been presented that an answer needs.
  bool takes_answer() const { return number_ >= needed_; }
  double asked_at() const { return asked_at_; }  ///< since when it does [s]
  bool is_over() const { return over_; }         ///< nothing sounds any more

 private:
  StudyTask task_ = StudyTask::Identification;
  double length_ = 0.0, gap_ = 0.0;  // of an interval, 0 without end; between them [s]
  bool several_ = false, sounds_ = false, shows_level_ = true, over_ = false;
  int number_ = 0, needed_ = 1;  // of the interval; that an answer needs
  double since_ = 0.0, asked_at_ = 0.0;
};

}  // namespace prostm
