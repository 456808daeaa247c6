#include "prostm/study/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "prostm/core/input_error.hpp"
#include "prostm/study/session/detail/session_lines.hpp"
#include "prostm/study/task/line_keys.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm {

using study::rounded;
using study::stamped;

namespace {

constexpr double kTryAgain = 1.0;     // between attempts to write pending lines [s]
constexpr double kClockJump = 1.0;    // smallest jump of the wall clock that is recorded [s]
constexpr double kHandPeriod = 0.05;  // between poses in a trial's line [s]

}  // namespace

StudySession::StudySession(const Protocol& protocol, int participant, ResponseFile& file,
                           const nlohmann::ordered_json& facts, const StudySight& now,
                           const std::optional<Replacement>& replaces)
    : protocol_(protocol),
      participant_(participant),
      file_(file),
      course_(protocol, replaces ? replaces->order : participant),
      extras_(protocol, replaces ? replaces->order : participant),
      wanted_(still_air()),
      training_left_(protocol.training.seconds),
      looked_(now.time),
      utc_offset_(now.utc - now.time),
      strengths_(protocol.methods.size() * protocol.scenes.size()) {
  const ResponseLine first = first_line(replaces);
  if (file.lines().empty()) {
    begin_file(first, facts, now);
  } else {
    resume_file(first, now);
  }
}

/// Whether the next trial is the first with its method.
bool StudySession::starts_method() const {
  return !course_.is_done() && course_.starts_method();
}

void StudySession::enter(StudyPhase phase, double time) {
  phase_ = phase;
  since_ = time;
  in_force_at_ = -1.0;
  waits_for_.clear();
  anyway_ = false;
  passed_over_.reset();
  extra_.reset();
  if (phase == StudyPhase::Settling) extra_ = extras_.next(trials_done(), course_.trial());
  wanted_ = still_air();
  if (phase != StudyPhase::Training) return;
  explored_ = 0;
  // with noise, training is silent until the page is seen to play it
  wanted_ = exploring(!protocol_.trials.noise);
}

/// The method of the trial, without a stimulus.
StudyWanted StudySession::still_air() const {
  return {.method = trial().method};
}

/// The current scene of training.
StudyWanted StudySession::exploring(bool sound) const {
  return {.method = trial().method,
          .scene = explored_,
          .sound = sound,
          .picture = protocol_.training.picture};
}

/// The trial's scene, with its level or the standard.
StudyWanted StudySession::stimulus(bool level, bool sound) const {
  const Trial& t = trial();
  const bool is_silent = extra_ && extra_->kind == ExtraKind::Catch;
  StudyWanted wanted = {.method = t.method, .scene = t.scene, .sound = sound && !is_silent};
  wanted.standard = !level && protocol_.standard;
  if (t.level && !wanted.standard) wanted.level = level ? *t.level : protocol_.level.reference;
  return wanted;
}

void StudySession::pass_consent(double time) {
  if (protocol_.study.demographics) return enter(StudyPhase::About, time);
  begin_method(time);
}

void StudySession::begin_method(double time) {
  extras_.begin_practice();
  training_left_ = protocol_.training.seconds;
  enter(training_left_ > 0.0 ? StudyPhase::Training : StudyPhase::Ready, time);
}

const StudyWanted& StudySession::look(const StudySight& sight) {
  watch_clock(sight);
  if (!unwritten_.empty() && sight.time - tried_ >= kTryAgain) write_rest(sight.time);
  const double passed = sight.time - looked_;
  looked_ = sight.time;
  gate_ = sight.in_force ? sight.gate : std::nullopt;
  watch_page(sight);
  if (phase_ == StudyPhase::Training) {
    wanted_ = exploring(page_.missing().none());
    if (wanted_.sound) training_left_ = std::max(0.0, training_left_ - passed);
    if (training_left_ == 0.0) end_training(sight);
  }
  if (phase_ == StudyPhase::Settling) settle(sight);
  if (phase_ == StudyPhase::Presenting) present(sight);
  if (phase_ == StudyPhase::Presenting && !sight.palm) hand_gone_ += passed;
  if (phase_ == StudyPhase::Presenting) page_.present(passed);
  return wanted_;
}

std::string StudySession::end_training(const StudySight& sight) {
  enter(StudyPhase::Ready, sight.time);
  return write({{line::kKind, line::kTraining},
                {"left_s", rounded(training_left_, 1)},
                {"page_missing", names_of(page_.missing())}},
               sight);
}

void StudySession::settle(const StudySight& sight) {
  if (sight.time - since_ < protocol_.trials.rest) return;
  if (!sight.palm) {
    waits_for_ = "There is no hand above the array.";
    wanted_ = still_air();  // so that the jets start under the hand when it returns
    in_force_at_ = -1.0;
    return;
  }
  if (wanted_.scene < 0) {
    wanted_ = stimulus(task().intervals(protocol_, trial()).shows_level.front(), false);
    return;
  }
  if (!sight.in_force) return;
  if (in_force_at_ < 0.0) in_force_at_ = sight.time;
  const bool open = protocol_.trials.gate != GateUse::Required || anyway_ || !gate_ || gate_->pass;
  waits_for_ = open ? "" : sentence(*gate_);
  if ((page_.missing() & ~passed_over_).any()) return;
  if (sight.time - in_force_at_ < protocol_.trials.settle || !open || !unwritten_.empty()) return;
  phase_ = StudyPhase::Presenting;
  since_ = sight.time;
  intervals_.begin(task().intervals(protocol_, trial()), sight.time);
  wanted_ = stimulus(intervals_.shows_level(), true);
  begun_with_ = trial().level;
  changes_ = nlohmann::ordered_json::array();
  gate_at_onset_ = gate_;
  strength_ = {};
  played_ = {};
  hand_ = nlohmann::ordered_json::array();
  hand_at_ = sight.time;
  hand_gone_ = 0.0;
  page_.begin_presentation();
}

void StudySession::present(const StudySight& sight) {
  const double time = sight.time - since_;
  intervals_.look(sight.time, sight.in_force);
  wanted_ = stimulus(intervals_.shows_level(), intervals_.is_playing());
  if (intervals_.is_over()) return;
  if (intervals_.is_playing() && intervals_.shows_level()) {
    strength_.target += sight.target_force;
    strength_.rendered += sight.rendered_force;
    ++strength_.looks;
    add_played(sight);
  }
  if (!sight.palm || sight.time < hand_at_) return;
  hand_.push_back(study::pose_json(time, *sight.palm));
  hand_at_ = std::max(hand_at_ + kHandPeriod, sight.time);
}

/// Accumulates the emission of the newest plan.
void StudySession::add_played(const StudySight& sight) {
  if (!sight.played) return;
  played_.speed += sight.played->speed;
  played_.period += sight.played->period;
  played_.changed = std::max(played_.changed, sight.played->changed);
  ++played_.looks;
}

/// Mean emission over the trial; null without a plan.
nlohmann::ordered_json StudySession::played_json() const {
  if (played_.looks == 0) return nullptr;
  return prostm::played_json(
      {played_.speed / played_.looks, played_.period / played_.looks, played_.changed});
}

void StudySession::watch_clock(const StudySight& sight) {
  const double offset = sight.utc - sight.time, jump = offset - utc_offset_;
  if (std::abs(jump) < kClockJump) return;
  utc_offset_ = offset;
  write({{line::kKind, line::kClock}, {"jump_s", rounded(jump, 3)}}, sight);
}

/// Writes a line, after any pending lines.
std::string StudySession::write(ResponseLine line, const StudySight& sight) {
  unwritten_.push_back(stamped(std::move(line), sight));
  return write_rest(sight.time);
}

std::string StudySession::write_rest(double time) {
  problem_.clear();
  tried_ = time;
  try {
    while (!unwritten_.empty()) {
      file_.append(unwritten_.front());
      unwritten_.erase(unwritten_.begin());
    }
  } catch (const InputError& error) {
    problem_ = error.what();
  }
  return problem_;
}

ResponseLine StudySession::trial_line(std::optional<int> answer, const StudySight& sight) const {
  const Trial& t = trial();
  const double looks = std::max(1, strength_.looks);
  ResponseLine line = {{line::kKind, line::kTrial}, {line::kTrial, trials_done() + 1}};
  task().add_stimulus(line, protocol_, t);
  if (answer) task().add_answer(line, protocol_, t, *answer);
  if (!answer) line[line::kStart] = begun_with_ ? *begun_with_ : *t.level;
  if (!answer) line[line::kChanges] = changes_;
  line[line::kResponseTime] = rounded(sight.time - intervals_.asked_at(), 3);
  line[line::kStimulus] = study::stimulus_hash(protocol_, t);
  line[line::kGate] = study::gate_json(gate_at_onset_);
  line[line::kAnyway] = anyway_;
  line[line::kTarget] = rounded(1e3 * strength_.target / looks, 4);
  line[line::kRendered] = rounded(1e3 * strength_.rendered / looks, 4);
  line[line::kPlayed] = played_json();
  line[line::kHandGone] = rounded(hand_gone_, 3);
  line[line::kPage] = page_.of_trial();
  line[line::kHand] = hand_;
  return line;
}

std::string StudySession::answer(const StudyAct& act, const StudySight& sight) {
  if (!intervals_.takes_answer()) {
    if (protocol_.trials.fixed_duration) return "the answer is taken after the stimulus";
    return fmt::format("{} intervals must be felt before an answer",
                       task().traits().intervals == 2 ? "both" : "all");
  }
  const std::variant<int, std::string> read = task().answer_of(act);
  if (const auto* refusal = std::get_if<std::string>(&read)) return *refusal;
  const int answer = std::get<int>(read);
  if (extra_) return end_extra(answer, sight);
  const ResponseLine line = trial_line(answer, sight);
  if (protocol_.trials.feedback) feedback_ = line[line::kCorrect] == 1;
  last_ = answer;
  end_trial(line, sight, [&] { course_.answer(task().felt(*last_trial_, answer)); });
  return problem_;
}

std::string StudySession::accept(const StudySight& sight) {
  if (!intervals_.takes_answer()) return "both intervals must be felt before the match is accepted";
  end_trial(trial_line({}, sight), sight, [&] { course_.accept(*last_trial_->level); });
  return problem_;
}

std::string StudySession::tune(const StudyAct& act, const StudySight& sight) {
  course_.tune(act.steps, act.coarse);
  changes_.push_back({rounded(sight.time - since_, 3), *trial().level});
  wanted_ = stimulus(intervals_.shows_level(), intervals_.is_playing());
  return {};
}

/// Writes a trial's line, and enters the next phase. @param count records its answer.
void StudySession::end_trial(const ResponseLine& line, const StudySight& sight,
                             const std::function<void()>& count) {
  const double looks = std::max(1, strength_.looks);
  add_strength(trial(), strength_.target / looks, strength_.rendered / looks);
  write(line, sight);
  last_trial_ = trial();
  page_.end_trial();
  count();
  note_bound(sight);
  if (course_.is_done()) {
    enter(StudyPhase::Done, sight.time);
    write({{line::kKind, line::kEnd},
           {line::kStrengths, strengths()},
           {"strength_difference", rounded(strength_difference(), 3)}},
          sight);
  } else if (starts_method()) {
    begin_method(sight.time);
  } else {
    const int every = protocol_.trials.break_every;
    const bool rests = every > 0 && trials_done() % static_cast<std::size_t>(every) == 0;
    enter(rests ? StudyPhase::Break : StudyPhase::Settling, sight.time);
  }
}

std::string StudySession::correct(const StudySight& sight) {
  const std::vector<int> answers = task().answers();
  if (answers.size() != 2) return "an answer can be changed only if there are two to choose from";
  if (!course_.correct())
    return "the last answer ended the staircases, so it can no longer be changed";
  last_ = *last_ == answers[0] ? answers[1] : answers[0];
  ResponseLine line = {{line::kKind, line::kCorrection}, {line::kTrial, trials_done()}};
  task().add_answer(line, protocol_, *last_trial_, *last_);
  if (protocol_.trials.feedback) feedback_ = line[line::kCorrect] == 1;
  // the changed answer may lead to another level
  if (phase_ == StudyPhase::Settling) enter(StudyPhase::Settling, sight.time);
  return write(line, sight);
}

std::string StudySession::explore(int scene) {
  if (scene < 0 || scene >= static_cast<int>(protocol_.scenes.size()))
    return "there is no such scene";
  explored_ = scene;
  wanted_ = exploring(wanted_.sound);
  return {};
}

bool StudySession::is_resting() const {
  return phase_ == StudyPhase::Ready || phase_ == StudyPhase::Break || phase_ == StudyPhase::Paused;
}

std::string StudySession::go_on(const StudySight& sight) {
  practice_failed_.clear();
  enter(StudyPhase::Settling, sight.time);
  return write({{line::kKind, line::kGo}}, sight);
}

std::string StudySession::take(const StudyAct& act, const StudySight& sight) {
  using Do = StudyAct::Do;
  const auto refuse = [&] {
    return fmt::format("\"{}\" is not possible now: the session is at \"{}\"", name_of(act.what),
                       name_of(phase_));
  };
  const bool over = phase_ == StudyPhase::Done || phase_ == StudyPhase::Withdrawn;
  switch (act.what) {
    case Do::Consent:
      if (phase_ != StudyPhase::Consent) return refuse();
      pass_consent(sight.time);
      return write({{line::kKind, line::kConsent}}, sight);
    case Do::About:
      if (phase_ != StudyPhase::About) return refuse();
      begin_method(sight.time);
      return write({{line::kKind, line::kAbout}, {"answers", act.about}}, sight);
    case Do::Explore:
      if (phase_ != StudyPhase::Training) return refuse();
      return explore(act.scene);
    case Do::Next:
      closed_ = over;
      if (over) return {};
      if (phase_ == StudyPhase::Training)
        return "the training is not over; \"end-training\" ends it before its time";
      return is_resting() ? go_on(sight) : refuse();
    case Do::EndTraining:
      if (phase_ != StudyPhase::Training) return refuse();
      return end_training(sight);
    case Do::Practise:
      if (phase_ != StudyPhase::Ready || practice_failed_.empty()) return refuse();
      return practise_again(sight);
    case Do::Anyway:
      if (phase_ != StudyPhase::Settling) return refuse();
      anyway_ = true;
      passed_over_ = page_.missing();
      return {};
    case Do::Answer:
      if (phase_ != StudyPhase::Presenting) return refuse();
      return answer(act, sight);
    case Do::Tune:
    case Do::Accept:
      if (phase_ != StudyPhase::Presenting || !task().is_tuned()) return refuse();
      return act.what == Do::Tune ? tune(act, sight) : accept(sight);
    case Do::Correct:
      if (phase_ == StudyPhase::Presenting || !last_ || phase_ == StudyPhase::Withdrawn)
        return refuse();
      return correct(sight);
    case Do::Pause:
      if (phase_ != StudyPhase::Settling && phase_ != StudyPhase::Presenting) return refuse();
      enter(StudyPhase::Paused, sight.time);
      return write({{line::kKind, line::kPause}}, sight);
    case Do::Withdraw:
      if (over) return refuse();
      enter(StudyPhase::Withdrawn, sight.time);
      return write({{line::kKind, line::kWithdrawn}}, sight);
  }
  return "there is no such act";
}

}  // namespace prostm
