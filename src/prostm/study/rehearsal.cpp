#include "prostm/study/rehearsal.hpp"

namespace prostm {
namespace {

constexpr double kFeels = 0.5;     // before it goes on, and before it answers [s]
constexpr double kPatience = 5.0;  // with a gate that does not pass [s]

}  // namespace

std::optional<StudyAct> Rehearsal::act(const StudySession& session, double time) {
  using Do = StudyAct::Do;
  if (!phase_) first_ = session.trials_done();
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
      return StudyAct{.what = Do::Answer, .yes = random_.below(2) == 0};
    default:
      return StudyAct{.what = Do::Next};
  }
}

}  // namespace prostm
