/// Trials within a session that are not of its course: practice, catch and attention trials.

#include <fmt/format.h>

#include "prostm/study/session/detail/session_lines.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm {

int StudySession::practice_trial() const {
  const bool before_trials = phase_ == StudyPhase::Training || phase_ == StudyPhase::Consent ||
                             phase_ == StudyPhase::About;
  if (before_trials || course_.is_done() || !extras_.practises()) return 0;
  return extras_.practice().trials() + 1;
}

bool StudySession::presents_nothing() const {
  return phase_ == StudyPhase::Presenting && intervals_.is_playing() && extra_ &&
         extra_->kind == ExtraKind::Catch;
}

std::string StudySession::question() const {
  if (extra_ && extra_->kind == ExtraKind::Attention) return extras_.instruction(*extra_);
  return protocol_.scenes[static_cast<std::size_t>(trial().question)].question;
}

/// Writes the line of an extra trial, and enters the next phase.
std::string StudySession::end_extra(int answer, const StudySight& sight) {
  const ExtraTrial extra = *extra_;
  const std::optional<bool> right = extras_.right_answer(extra, answer);
  ResponseLine line = {{line::kKind, name_of(extra.kind)}, {line::kTrial, trials_done() + 1}};
  task().add_stimulus(line, protocol_, extra.trial);
  if (extra.kind == ExtraKind::Attention) line[line::kQuestion] = question();
  line[line::kAnswer] = answer;
  if (right) line[line::kRight] = *right ? 1 : 0;
  line[line::kResponseTime] = study::rounded(sight.time - intervals_.asked_at(), 3);
  write(line, sight);
  page_.end_trial();
  last_.reset();  // a correction changes the answer to a trial of the course
  const bool tells = protocol_.trials.feedback || extra.kind == ExtraKind::Practice;
  feedback_ = tells ? right : std::nullopt;
  extras_.answer(extra.kind, trials_done(), right.value_or(true));
  if (extra.kind == ExtraKind::Practice && !extras_.practises()) return end_practice(sight);
  enter(StudyPhase::Settling, sight.time);
  return problem_;
}

std::string StudySession::end_practice(const StudySight& sight) {
  const Practice& practice = extras_.practice();
  const StudyMethod& method = protocol_.methods[static_cast<std::size_t>(trial().method)];
  enter(StudyPhase::Ready, sight.time);
  if (!practice.passed()) {
    practice_failed_ = fmt::format(
        "The practice ended without its criterion: {:.0f} % of the last {} answers were right, "
        "and the protocol asks for {:.0f} %. Check that the participant has understood the task.",
        100.0 * practice.share(), protocol_.practice.window, 100.0 * protocol_.practice.right);
    news_.push_back(practice_failed_);
  }
  return write({{line::kKind, line::kPractised},
                {line::kMethod, method.name},
                {line::kTrials, practice.trials()},
                {line::kRight, study::rounded(practice.share(), 3)},
                {line::kPassed, practice.passed()}},
               sight);
}

std::string StudySession::practise_again(const StudySight& sight) {
  extras_.begin_practice();
  practice_failed_.clear();
  enter(StudyPhase::Settling, sight.time);
  return write({{line::kKind, line::kPractiseAgain}}, sight);
}

/// Replays one extra trial.
void StudySession::repeat_extra(ExtraKind kind, const ResponseLine& line) {
  page_.end_trial();
  last_.reset();
  const bool right =
      !line.contains(line::kRight) || study::number_in(line, line::kRight, file_.path()) == 1.0;
  extras_.answer(kind, trials_done(), right);
}

}  // namespace prostm
