#pragma once
/// A session without people: whether everything works, before the first participant comes.

#include <cstdint>
#include <optional>

#include "prostm/core/random.hpp"
#include "prostm/study/session.hpp"

namespace prostm {

/// Goes on by itself, and answers at random.
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
  std::optional<StudyPhase> phase_;  // that was seen last
  std::size_t first_ = 0;            // answers that there were before
  double since_ = 0.0;               // when the phase began [s]
  bool done_ = false;
};

}  // namespace prostm
