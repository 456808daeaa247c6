#pragma once
/// A session without people, to test the setup before the first participant.

#include <cstdint>
#include <optional>

#include "prostm/core/random.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/perception.hpp"

namespace prostm {

/// A simulated participant for tasks with levels, who answers by Task::respond().
class SimulatedPerson {
 public:
  /// @pre the protocol outlives this, and its task has levels. @param threshold level half-way
  /// between the guess rate and the upper asymptote, in the setting's unit.
  SimulatedPerson(const Protocol& protocol, double threshold, std::uint64_t seed);
  /// The act that answers or tunes a trial.
  StudyAct act(const Trial& trial);

 private:
  const Task& task_;
  Perception perception_;
};

/// Runs a session automatically. It answers tasks without levels at random, and others as a
/// simulated person with a threshold drawn from the middle third of the levels.
class Rehearsal {
 public:
  /// @param trials number of trials to answer; 0: all.
  Rehearsal(std::size_t trials, std::uint64_t seed) : trials_(trials), random_(seed) {}

  /// The act that is due now, if any.
  std::optional<StudyAct> act(const StudySession& session, double time);
  /// Whether the run may end: the trials are answered, or one cannot begin.
  bool is_done() const { return done_; }

 private:
  std::size_t trials_;
  Random random_;
  std::optional<SimulatedPerson>
      person_;                       // for tasks with levels, created when a session is first seen
  std::optional<StudyPhase> phase_;  // phase at the last call
  std::size_t first_ = 0;            // answers given before the rehearsal
  double since_ = 0.0;               // start of the phase [s]
  bool done_ = false;
};

}  // namespace prostm
