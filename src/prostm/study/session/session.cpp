#include "prostm/study/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/core/input_error.hpp"
#include "prostm/study/session/detail/session_lines.hpp"

namespace prostm {

using study::rounded;
using study::stamped;

namespace {

constexpr double kTryAgain = 1.0;     // between tries to write what could not be written [s]
constexpr double kClockJump = 1.0;    // of the day's clock that is written down [s]
constexpr double kHandPeriod = 0.05;  // between poses in a trial's line [s]

}  // namespace

nlohmann::ordered_json played_json(const StudyPlayed& played) {
  return {{"speed_m_s", rounded(played.speed, 4)},
          {"period_ms", rounded(1e3 * played.period, 4)},
          {"changed_paths", played.changed}};
}

StudySession::StudySession(const Protocol& protocol, int participant, ResponseFile& file,
                           const nlohmann::ordered_json& facts, const StudySight& now,
                           const std::optional<Replacement>& replaces)
    : protocol_(protocol),
      participant_(participant),
      file_(file),
      course_(protocol, replaces ? replaces->order : participant),
      strengths_(protocol.methods.size() * protocol.scenes.size()) {
  utc_offset_ = now.utc - now.time;
  looked_ = now.time;
  training_left_ = protocol.training.seconds;
  wanted_.method = trial().method;
  ResponseLine first = {
      {"kind", "begin"}, {"format", kResponseFormat}, {"participant", std::to_string(participant)}};
  if (replaces) {
    first["replaces"] = replaces->participant;
    first["order"] = replaces->order;
  }
  first["protocol"] = protocol_json(protocol);
  first["trials"] = course_.most();
  if (file.lines().empty()) {
    ResponseLine line = first;
    line["run"] = facts;
    file.append(stamped(std::move(line), now));
    if (protocol.study.consent.empty()) {
      pass_consent(now.time);
    } else {
      enter(StudyPhase::Consent, now.time);
    }
    return;
  }
  for (const auto& [key, value] : first.items()) {
    const ResponseLine& held = file.lines().front();
    if (held.contains(key) && held[key] == value) continue;
    throw InputError(fmt::format(
        "{} was begun with another {}; go on with the one that it was begun with, or give this "
        "participant another number",
        file.path(), key));
  }
  const StudyPhase phase = replay();
  if (phase == StudyPhase::Done || phase == StudyPhase::Withdrawn) {
    throw InputError(fmt::format("{}: participant {} {}; give the next one another number",
                                 file.path(), participant,
                                 phase == StudyPhase::Done ? "has given all answers" : "left"));
  }
  write({{"kind", "resume"}}, now);
  wanted_.method = trial().method;
  enter(phase, now.time);
}

/// Does again what the lines of the file did. @return the phase to go on from.
StudyPhase StudySession::replay() {
  bool consented = protocol_.study.consent.empty(), told = !protocol_.study.demographics;
  bool trained = false, withdrawn = false;
  for (const ResponseLine& line : file_.lines()) {
    const std::string kind = line.value("kind", "");
    consented = consented || kind == "consent";
    told = told || kind == "about";
    withdrawn = withdrawn || kind == "withdrawn";
    if (kind == "training") trained = true;
    if (kind == "correction") repeat_correction(line);
    if (kind == "interrupted") page_.interrupt();
    if (kind != "trial") continue;
    if (course_.is_done()) throw InputError(file_.path() + " has more trials than there are");
    repeat_trial(line);
    if (starts_method()) trained = false;
  }
  if (withdrawn) return StudyPhase::Withdrawn;
  if (course_.is_done()) return StudyPhase::Done;
  if (!consented) return StudyPhase::Consent;
  if (!told) return StudyPhase::About;
  const bool trains = protocol_.training.seconds > 0.0 && starts_method() && !trained;
  return trains ? StudyPhase::Training : StudyPhase::Ready;
}

/// Does again what a trial's line did.
void StudySession::repeat_trial(const ResponseLine& line) {
  const Trial t = trial();
  const double level = t.level ? study::number_in(line, "level", file_.path()) : 0.0;
  if (t.level && protocol_.trials.task != StudyTask::Adjustment &&
      std::abs(level - *t.level) > 1e-5 * std::abs(*t.level)) {
    throw InputError(fmt::format(
        "{}: trial {} has level {:g}, and its staircase asks for {:g}; go on with the version of "
        "prostm that it was begun with",
        file_.path(), trials_done() + 1, level, *t.level));
  }
  const auto force = [&](const char* key) {
    return 1e-3 * study::number_in(line, key, file_.path());
  };
  add_strength(t, force("target_mn"), force("rendered_mn"));
  page_.end_trial();
  last_trial_ = t;
  if (protocol_.trials.task == StudyTask::Adjustment) return course_.accept(level);
  last_ = study::chose(protocol_, line, file_.path());
  course_.answer(study::felt(protocol_, t, *last_));
}

void StudySession::repeat_correction(const ResponseLine& line) {
  last_ = study::chose(protocol_, line, file_.path());
  if (!course_.correct()) throw InputError(file_.path() + " corrects what cannot be corrected");
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
  wanted_.sound = wanted_.picture = false;
  wanted_.scene = -1;
  wanted_.level.reset();
  wanted_.standard = false;
  if (phase == StudyPhase::Training) {
    explored_ = 0;
    wanted_.scene = 0;
    wanted_.sound = !protocol_.trials.noise;  // which is seen to play first
    wanted_.picture = protocol_.training.picture;
  }
}

void StudySession::pass_consent(double time) {
  if (protocol_.study.demographics) return enter(StudyPhase::About, time);
  begin_method(time);
}

void StudySession::begin_method(double time) {
  wanted_.method = trial().method;
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
    wanted_.sound = page_.missing().none();
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
  return write({{"kind", "training"},
                {"left_s", rounded(training_left_, 1)},
                {"page_missing", names_of(page_.missing())}},
               sight);
}

void StudySession::settle(const StudySight& sight) {
  if (sight.time - since_ < protocol_.trials.rest) return;
  if (!sight.palm) {
    waits_for_ = "There is no hand above the array.";
    wanted_.scene = -1;  // so that jets blow under the hand when it is back
    in_force_at_ = -1.0;
    return;
  }
  if (wanted_.scene < 0) {
    wanted_.scene = trial().scene;
    want(Intervals::begins_with_level(protocol_, trial()));
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
  intervals_.begin(protocol_, trial(), sight.time);
  wanted_.sound = true;
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
  wanted_.sound = intervals_.sounds();
  want(intervals_.shows_level());
  if (intervals_.is_over()) return;
  if (intervals_.sounds() && intervals_.shows_level()) {
    strength_.target += sight.target_force;
    strength_.rendered += sight.rendered_force;
    ++strength_.looks;
    add_played(sight);
  }
  if (!sight.palm || sight.time < hand_at_) return;
  hand_.push_back(study::pose_json(time, *sight.palm));
  hand_at_ = std::max(hand_at_ + kHandPeriod, sight.time);
}

/// Adds how the newest plan is played.
void StudySession::add_played(const StudySight& sight) {
  if (!sight.played) return;
  played_.speed += sight.played->speed;
  played_.period += sight.played->period;
  played_.changed = std::max(played_.changed, sight.played->changed);
  ++played_.looks;
}

/// Means over the trial; null without a plan.
nlohmann::ordered_json StudySession::played_json() const {
  if (played_.looks == 0) return nullptr;
  return prostm::played_json(
      {played_.speed / played_.looks, played_.period / played_.looks, played_.changed});
}

/// Wants the trial's level, or the standard.
void StudySession::want(bool level) {
  const Trial& t = trial();
  wanted_.standard = !level && protocol_.standard;
  wanted_.level.reset();
  if (t.level && !wanted_.standard) wanted_.level = level ? *t.level : protocol_.level.reference;
}

void StudySession::watch_clock(const StudySight& sight) {
  const double offset = sight.utc - sight.time, jump = offset - utc_offset_;
  if (std::abs(jump) < kClockJump) return;
  utc_offset_ = offset;
  write({{"kind", "clock"}, {"jump_s", rounded(jump, 3)}}, sight);
}

/// Writes a line, after those that could not be written before.
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

ResponseLine StudySession::trial_line(std::optional<bool> chosen, const StudySight& sight) const {
  const Trial& t = trial();
  const double looks = std::max(1, strength_.looks);
  ResponseLine line = {{"kind", "trial"}, {"trial", trials_done() + 1}};
  study::add_stimulus(line, protocol_, t);
  if (chosen) study::add_answer(line, protocol_, t, *chosen);
  if (!chosen) line["start"] = begun_with_ ? *begun_with_ : *t.level;
  if (!chosen) line["changes"] = changes_;
  line["response_s"] = rounded(sight.time - intervals_.asked_at(), 3);
  line["stimulus"] = study::stimulus_hash(protocol_, t);
  line["gate"] = study::gate_json(gate_at_onset_);
  line["anyway"] = anyway_;
  line["target_mn"] = rounded(1e3 * strength_.target / looks, 4);
  line["rendered_mn"] = rounded(1e3 * strength_.rendered / looks, 4);
  line["played"] = played_json();
  line["hand_gone_s"] = rounded(hand_gone_, 3);
  line["page"] = page_.of_trial();
  line["hand"] = hand_;
  return line;
}

std::string StudySession::answer(const StudyAct& act, const StudySight& sight) {
  if (!intervals_.takes_answer()) return "both intervals are to be felt before an answer";
  const StudyTask task = protocol_.trials.task;
  if (task == StudyTask::Adjustment) return "an adjustment has no answer: tune it and accept it";
  const bool of_intervals = task == StudyTask::ForcedChoice;
  if (of_intervals != (act.interval > 0))
    return of_intervals ? "the answer is an interval, 1 or 2" : "the answer is yes or no";
  const bool chosen = of_intervals ? act.interval == 2 : act.yes;
  const ResponseLine line = trial_line(chosen, sight);
  if (protocol_.trials.feedback) feedback_ = line["correct"] == 1;
  last_ = chosen;
  end_trial(line, sight, [&] { course_.answer(study::felt(protocol_, *last_trial_, chosen)); });
  return problem_;
}

std::string StudySession::accept(const StudySight& sight) {
  if (!intervals_.takes_answer()) return "both are to be felt before they are alike";
  end_trial(trial_line({}, sight), sight, [&] { course_.accept(*last_trial_->level); });
  return problem_;
}

std::string StudySession::tune(const StudyAct& act, const StudySight& sight) {
  course_.tune(act.steps, act.coarse);
  changes_.push_back({rounded(sight.time - since_, 3), *trial().level});
  want(intervals_.shows_level());
  return {};
}

/// Writes a trial's line, and goes on to what follows it. @param count counts its answer.
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
    write({{"kind", "end"},
           {"strengths", strengths()},
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
  if (!course_.correct())
    return "the last answer ended the staircases, so it can no longer be changed";
  last_ = !*last_;
  ResponseLine line = {{"kind", "correction"}, {"trial", trials_done()}};
  study::add_answer(line, protocol_, *last_trial_, *last_);
  if (protocol_.trials.feedback) feedback_ = line["correct"] == 1;
  // another level may follow from another answer
  if (phase_ == StudyPhase::Settling) enter(StudyPhase::Settling, sight.time);
  return write(line, sight);
}

std::string StudySession::take(const StudyAct& act, const StudySight& sight) {
  using Do = StudyAct::Do;
  const auto refuse = [&] {
    return fmt::format("\"{}\" is not for now: the session is at \"{}\"", name_of(act.what),
                       name_of(phase_));
  };
  const bool over = phase_ == StudyPhase::Done || phase_ == StudyPhase::Withdrawn;
  switch (act.what) {
    case Do::Consent:
      if (phase_ != StudyPhase::Consent) return refuse();
      pass_consent(sight.time);
      return write({{"kind", "consent"}}, sight);
    case Do::About:
      if (phase_ != StudyPhase::About) return refuse();
      begin_method(sight.time);
      return write({{"kind", "about"}, {"answers", act.about}}, sight);
    case Do::Explore:
      if (phase_ != StudyPhase::Training) return refuse();
      if (act.scene < 0 || act.scene >= static_cast<int>(protocol_.scenes.size()))
        return "there is no such scene to explore";
      explored_ = wanted_.scene = act.scene;
      return {};
    case Do::Next:
      closed_ = over;
      if (over) return {};
      if (phase_ == StudyPhase::Training) return end_training(sight);
      if (phase_ != StudyPhase::Ready && phase_ != StudyPhase::Break &&
          phase_ != StudyPhase::Paused)
        return refuse();
      enter(StudyPhase::Settling, sight.time);
      return write({{"kind", "go"}}, sight);
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
      if (phase_ != StudyPhase::Presenting || protocol_.trials.task != StudyTask::Adjustment)
        return refuse();
      return act.what == Do::Tune ? tune(act, sight) : accept(sight);
    case Do::Correct:
      if (phase_ == StudyPhase::Presenting || !last_ || phase_ == StudyPhase::Withdrawn)
        return refuse();
      return correct(sight);
    case Do::Pause:
      if (phase_ != StudyPhase::Settling && phase_ != StudyPhase::Presenting) return refuse();
      enter(StudyPhase::Paused, sight.time);
      return write({{"kind", "pause"}}, sight);
    case Do::Withdraw:
      if (over) return refuse();
      enter(StudyPhase::Withdrawn, sight.time);
      return write({{"kind", "withdrawn"}}, sight);
  }
  return refuse();
}

}  // namespace prostm
