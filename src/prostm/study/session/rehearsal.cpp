#include "prostm/study/session/rehearsal.hpp"

#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

constexpr double kFeels = 0.5;     // delay before it continues, and before it answers [s]
constexpr double kPatience = 5.0;  // time it waits for a gate that does not pass [s]

}  // namespace

SimulatedPerson::SimulatedPerson(const Protocol& protocol, double threshold, std::uint64_t seed)
    : task_(*protocol.trials.task),
      perception_(protocol.level, threshold, task_.guess(protocol), seed) {}

StudyAct SimulatedPerson::act(const Trial& trial) {
  return task_.respond(trial, perception_);
}

std::optional<StudyAct> Rehearsal::act(const StudySession& session, double time) {
  using Do = StudyAct::Do;
  if (!phase_) first_ = session.trials_done();
  const Protocol& protocol = session.protocol();
  const Task& task = *protocol.trials.task;
  if (!person_ && task.traits().has_levels) {
    const double threshold = random_.uniform(1.0 / 3.0, 2.0 / 3.0);
    const LevelRange range = protocol.level.range();
    person_.emplace(protocol,
                    protocol.level.from_scale(range.low + threshold * (range.high - range.low)),
                    random_.bits());
  }
  if (session.phase() != phase_) since_ = time;
  phase_ = session.phase();
  const double passed = time - since_;
  const bool waits = phase_ == StudyPhase::Settling && !session.waits_for().empty();
  done_ = (trials_ > 0 && session.trials_done() - first_ >= trials_) ||
          (waits && passed > 2.0 * kPatience);
  if (passed < kFeels || done_) return {};
  switch (*phase_) {
    case StudyPhase::Consent:
      return StudyAct{.what = Do::Consent};
    case StudyPhase::About:
      return StudyAct{.what = Do::About};
    case StudyPhase::Training:
      return StudyAct{.what = Do::EndTraining};
    case StudyPhase::Settling:
      if (!waits || passed < kPatience) return {};
      return StudyAct{.what = Do::Anyway};
    case StudyPhase::Presenting:
      if (!session.takes_answer()) return {};
      if (session.extra() && session.extra()->wanted) return task.act_of(*session.extra()->wanted);
      if (person_) return person_->act(session.trial());
      return task.guessed(random_);
    default:
      return StudyAct{.what = Do::Next};
  }
}

}  // namespace prostm
