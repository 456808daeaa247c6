/// Begins a session's file, or resumes a session from it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/study/session/detail/session_lines.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/protocol_file.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

int answer_in(const ResponseLine& line, const std::string& file) {
  constexpr double kMost = 1000.0;
  return static_cast<int>(std::clamp(study::number_in(line, line::kAnswer, file), -kMost, kMost));
}

}  // namespace

/// The first line of the file, without the facts about the run.
ResponseLine StudySession::first_line(const std::optional<Replacement>& replaces) const {
  ResponseLine first = {{line::kKind, line::kBegin},
                        {line::kFormat, kResponseFormat},
                        {line::kParticipant, std::to_string(participant_)}};
  if (replaces) {
    first[line::kReplaces] = replaces->participant;
    first[line::kOrder] = replaces->order;
  }
  first[line::kProtocol] = protocol_json(protocol_);
  first[line::kTrials] = course_.most();
  return first;
}

void StudySession::begin_file(const ResponseLine& first, const nlohmann::ordered_json& facts,
                              const StudySight& now) {
  ResponseLine line = first;
  line[line::kRun] = facts;
  file_.append(study::stamped(std::move(line), now));
  if (protocol_.study.consent.empty()) return pass_consent(now.time);
  enter(StudyPhase::Consent, now.time);
}

void StudySession::resume_file(const ResponseLine& first, const StudySight& now) {
  require_same_study(first);
  const StudyPhase phase = replay();
  require_open(phase);
  write({{line::kKind, line::kResume}}, now);
  enter(phase, now.time);
}

/// @throws InputError: the file was begun with another protocol or participant.
void StudySession::require_same_study(const ResponseLine& first) const {
  const ResponseLine& held = file_.lines().front();
  for (const auto& [key, value] : first.items()) {
    if (held.contains(key) && held[key] == value) continue;
    throw InputError(fmt::format(
        "{} was begun with another {}; use the original one, or give this participant another "
        "number",
        file_.path(), key));
  }
}

/// @throws InputError: the session of the file is over.
void StudySession::require_open(StudyPhase phase) const {
  if (phase != StudyPhase::Done && phase != StudyPhase::Withdrawn) return;
  throw InputError(fmt::format("{}: participant {} {}; give the next one another number",
                               file_.path(), participant_,
                               phase == StudyPhase::Done ? "has given all answers" : "left"));
}

/// Replays the lines of the file. @return the phase to go on from.
StudyPhase StudySession::replay() {
  bool consented = protocol_.study.consent.empty(), told = !protocol_.study.demographics;
  bool trained = false, withdrawn = false;
  for (const ResponseLine& line : file_.lines()) {
    const std::string kind = line.value(line::kKind, "");
    consented = consented || kind == line::kConsent;
    told = told || kind == line::kAbout;
    withdrawn = withdrawn || kind == line::kWithdrawn;
    if (kind == line::kTraining) trained = true;
    if (kind == line::kCorrection) repeat_correction(line);
    if (kind == line::kInterrupted) page_.interrupt();
    for (std::size_t i = 0; i < kNames<ExtraKind>.size(); ++i)
      if (kind == kNames<ExtraKind>[i]) repeat_extra(static_cast<ExtraKind>(i), line);
    if (kind == line::kPractiseAgain) extras_.begin_practice();
    if (kind != line::kTrial) continue;
    if (course_.is_done()) throw InputError(file_.path() + " has more trials than its protocol");
    repeat_trial(line);
    if (!starts_method()) continue;
    trained = false;
    extras_.begin_practice();
  }
  if (withdrawn) return StudyPhase::Withdrawn;
  if (course_.is_done()) return StudyPhase::Done;
  if (!consented) return StudyPhase::Consent;
  if (!told) return StudyPhase::About;
  const bool trains = protocol_.training.seconds > 0.0 && starts_method() && !trained;
  return trains ? StudyPhase::Training : StudyPhase::Ready;
}

/// Replays one trial.
void StudySession::repeat_trial(const ResponseLine& line) {
  const Trial t = trial();
  const double level = t.level ? study::number_in(line, line::kLevel, file_.path()) : 0.0;
  if (t.level && !task().is_tuned() && std::abs(level - *t.level) > 1e-5 * std::abs(*t.level)) {
    throw InputError(fmt::format(
        "{}: trial {} has level {:g}, but its staircase asks for {:g}; resume with the version of "
        "prostm that began the file",
        file_.path(), trials_done() + 1, level, *t.level));
  }
  const auto force = [&](const char* key) {
    return 1e-3 * study::number_in(line, key, file_.path());
  };
  add_strength(t, force(line::kTarget), force(line::kRendered));
  page_.end_trial();
  last_trial_ = t;
  if (task().is_tuned()) return course_.accept(level);
  last_ = answer_in(line, file_.path());
  course_.answer(task().felt(t, *last_));
}

void StudySession::repeat_correction(const ResponseLine& line) {
  last_ = answer_in(line, file_.path());
  if (!course_.correct())
    throw InputError(file_.path() + " corrects an answer that cannot be corrected");
}

}  // namespace prostm
