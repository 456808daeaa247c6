#pragma once
/// A session without people: whether everything works, before the first participant comes.

#include <cstdint>
#include <optional>

#include "prostm/core/random.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/perception.hpp"

namespace prostm {

/// A simulated person at levels, who answers as the task has a model observer answer.
class SimulatedPerson {
 public:
  /// @pre the protocol outlives this, and its task has levels. @param threshold the level half-way
  /// between guessing and the most, in the setting's unit.
  SimulatedPerson(const Protocol& protocol, double threshold, std::uint64_t seed);
  /// The act that answers a trial, or tunes it.
  StudyAct act(const Trial& trial);

 private:
  const Task& task_;
  Perception perception_;
};

/// Goes on by itself, and answers: a task without levels at random, others as a simulated person
/// does whose threshold is drawn from the middle third of the levels.
class Rehearsal {
 public:
  /// @param trials to answer; 0: all.
  Rehearsal(std::size_t trials, std::uint64_t seed) : trials_(trials), random_(seed) {}

  /// The act that is due now, if any.
  std::optional<StudyAct> act(const StudySession& session, double time);
  /// Whether the run may end: the trials are answered, or one cannot begin.
  bool is_done() const { return done_; }

 private:
  std::size_t trials_;
  Random random_;
  std::optional<SimulatedPerson> person_;  // of tasks with levels, once a session is seen
  std::optional<StudyPhase> phase_;        // that was seen last
  std::size_t first_ = 0;                  // answers that there were before
  double since_ = 0.0;                     // when the phase began [s]
  bool done_ = false;
};

}  // namespace prostm
