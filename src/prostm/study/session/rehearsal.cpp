#include "prostm/study/session/rehearsal.hpp"

#include <cmath>

namespace prostm {
namespace {

constexpr double kFeels = 0.5;     // before it goes on, and before it answers [s]
constexpr double kPatience = 5.0;  // with a gate that does not pass [s]

constexpr double kSlope = 20.0;     // of a simulated person, over the range of levels
constexpr double kNoise = 0.02;     // of what they feel in an adjustment, of the range
constexpr double kContent = 0.015;  // with a difference, of the range
constexpr double kFar = 0.15;       // a difference that is tuned in large steps, of the range

}  // namespace

SimulatedPerson::SimulatedPerson(const Protocol& protocol, double threshold, std::uint64_t seed)
    : protocol_(protocol),
      width_(protocol.level.range().high - protocol.level.range().low),
      random_(seed) {
  felt_.threshold = protocol.level.to_scale(threshold);
  felt_.slope = kSlope / width_;
  felt_.guess = has_right_answers(protocol) ? 0.5 : 0.0;
}

StudyAct SimulatedPerson::act(const Trial& trial) {
  using Do = StudyAct::Do;
  const double level = protocol_.level.to_scale(*trial.level);
  if (protocol_.trials.task == StudyTask::Adjustment) {
    const double off = (level - felt_.threshold) / width_ + kNoise * random_.normal();
    if (std::abs(off) < kContent) return {.what = Do::Accept};
    return {.what = Do::Tune, .steps = off > 0.0 ? -1 : 1, .coarse = std::abs(off) > kFar};
  }
  const bool felt = random_.uniform() < felt_.at(level);
  if (protocol_.trials.task == StudyTask::Judgement) return {.what = Do::Answer, .yes = felt};
  return {.what = Do::Answer, .interval = felt == trial.level_first ? 1 : 2};
}

std::optional<StudyAct> Rehearsal::act(const StudySession& session, double time) {
  using Do = StudyAct::Do;
  if (!phase_) first_ = session.trials_done();
  const Protocol& protocol = session.protocol();
  if (!person_ && protocol.trials.task != StudyTask::Identification) {
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
    case StudyPhase::Settling:
      if (!waits || passed < kPatience) return {};
      return StudyAct{.what = Do::Anyway};
    case StudyPhase::Presenting:
      if (!session.takes_answer()) return {};
      if (person_) return person_->act(session.trial());
      return StudyAct{.what = Do::Answer, .yes = random_.below(2) == 0};
    default:
      return StudyAct{.what = Do::Next};
  }
}

}  // namespace prostm
