#include "prostm/study/session.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"

namespace prostm {
namespace {

constexpr double kTryAgain = 1.0;     // between tries to write what could not be written [s]
constexpr double kClockJump = 1.0;    // of the day's clock that is written down [s]
constexpr double kHandPeriod = 0.05;  // between poses in a trial's line [s]

/// A number with so many decimals, so that files stay small.
double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(scale * value) / scale;
}

/// [s, x, y, z in mm, quaternion x, y, z, w]
nlohmann::ordered_json pose_json(double time, const Pose& X_DP) {
  nlohmann::ordered_json json = {rounded(time, 3)};
  for (int axis = 0; axis < 3; ++axis) json.push_back(rounded(1e3 * X_DP.translation()[axis], 1));
  const Quat q(X_DP.rotation());
  for (const double part : {q.x(), q.y(), q.z(), q.w()}) json.push_back(rounded(part, 4));
  return json;
}

nlohmann::ordered_json gate_json(const std::optional<GateResult>& gate) {
  if (!gate) return nullptr;
  return {{"pass", gate->pass},
          {"share", rounded(gate->share, 3)},
          {"problem", name_of(gate->finding.problem)},
          {"maxima", gate->shape.count()},
          {"balance", rounded(gate->shape.balance, 3)},
          {"saddle", rounded(gate->shape.saddle, 3)},
          {"area_cm2", rounded(1e4 * gate->shape.area, 1)},
          {"force_mn", rounded(1e3 * gate->shape.force, 3)}};
}

/// CRC-32 of all that makes a stimulus: version, settings and scene.
std::string stimulus_hash(const nlohmann::ordered_json& settings, const std::string& scene) {
  boost::crc_32_type sum;
  const std::string text = settings.dump() + scene;
  sum.process_bytes(text.data(), text.size());
  return fmt::format("{:08x}", sum.checksum());
}

ResponseLine stamped(ResponseLine line, const StudySight& sight) {
  line["utc"] = utc_text(sight.utc);
  line["time_s"] = rounded(sight.time, 4);
  return line;
}

}  // namespace

std::string utc_text(double seconds) {
  const auto whole = static_cast<std::time_t>(std::floor(seconds));
  const int milliseconds = static_cast<int>(1e3 * (seconds - std::floor(seconds)));
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(whole), milliseconds);
}

StudySession::StudySession(const Protocol& protocol, int participant, ResponseFile& file,
                           const nlohmann::ordered_json& facts, const StudySight& now)
    : protocol_(protocol),
      participant_(participant),
      file_(file),
      trials_(trial_order(protocol, participant)),
      strengths_(protocol.methods.size() * protocol.scenes.size()) {
  utc_offset_ = now.utc - now.time;
  looked_ = now.time;
  training_left_ = protocol.training.seconds;
  wanted_.method = trials_.front().method;
  const ResponseLine first = {{"kind", "begin"},
                              {"format", kResponseFormat},
                              {"participant", std::to_string(participant)},
                              {"protocol", protocol_json(protocol)},
                              {"trials", trials_.size()}};
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
    if (kind == "trial" || kind == "correction") last_ = line.value("answer", 0) == 1;
    if (kind != "trial") continue;
    if (done_ == trials_.size()) throw InputError(file_.path() + " has more trials than there are");
    add_strength(trial(), 1e-3 * line.value("target_mn", 0.0),
                 1e-3 * line.value("rendered_mn", 0.0));
    ++done_;
    if (starts_method()) trained = false;
  }
  if (withdrawn) return StudyPhase::Withdrawn;
  if (done_ == trials_.size()) return StudyPhase::Done;
  if (!consented) return StudyPhase::Consent;
  if (!told) return StudyPhase::About;
  const bool trains = protocol_.training.seconds > 0.0 && starts_method() && !trained;
  return trains ? StudyPhase::Training : StudyPhase::Ready;
}

/// Whether the next trial is the first with its method.
bool StudySession::starts_method() const {
  return done_ < trials_.size() && (done_ == 0 || trials_[done_ - 1].method != trial().method);
}

void StudySession::enter(StudyPhase phase, double time) {
  phase_ = phase;
  since_ = time;
  in_force_at_ = -1.0;
  waits_for_.clear();
  anyway_ = ended_ = false;
  wanted_.sound = wanted_.picture = false;
  wanted_.scene = -1;
  if (phase == StudyPhase::Training) {
    explored_ = 0;
    wanted_.scene = 0;
    wanted_.sound = true;
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
  if (phase_ == StudyPhase::Training) {
    training_left_ = std::max(0.0, training_left_ - passed);
    if (training_left_ == 0.0) end_training(sight);
  }
  if (phase_ == StudyPhase::Settling) settle(sight);
  if (phase_ == StudyPhase::Presenting) present(sight);
  if (phase_ == StudyPhase::Presenting && !sight.palm) hand_gone_ += passed;
  return wanted_;
}

std::string StudySession::end_training(const StudySight& sight) {
  enter(StudyPhase::Ready, sight.time);
  return write({{"kind", "training"}, {"left_s", rounded(training_left_, 1)}}, sight);
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
    return;
  }
  if (!sight.in_force) return;
  if (in_force_at_ < 0.0) in_force_at_ = sight.time;
  const bool open = protocol_.trials.gate != GateUse::Required || anyway_ || !gate_ || gate_->pass;
  waits_for_ = open ? "" : sentence(*gate_);
  if (sight.time - in_force_at_ < protocol_.trials.settle || !open || !unwritten_.empty()) return;
  phase_ = StudyPhase::Presenting;
  since_ = sight.time;
  wanted_.sound = true;
  gate_at_onset_ = gate_;
  strength_ = {};
  hand_ = nlohmann::ordered_json::array();
  hand_at_ = sight.time;
  hand_gone_ = 0.0;
}

void StudySession::present(const StudySight& sight) {
  const double time = sight.time - since_;
  const double limit = protocol_.trials.time_limit;
  if (limit > 0.0 && time >= limit && !ended_) {
    ended_ = true;
    wanted_.sound = false;
  }
  if (ended_) return;
  strength_.target += sight.target_force;
  strength_.rendered += sight.rendered_force;
  ++strength_.looks;
  if (!sight.palm || sight.time < hand_at_) return;
  hand_.push_back(pose_json(time, *sight.palm));
  hand_at_ = std::max(hand_at_ + kHandPeriod, sight.time);
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

ResponseLine StudySession::trial_line(bool yes, const StudySight& sight) const {
  const Trial& t = trial();
  const StudyMethod& method = protocol_.methods[static_cast<std::size_t>(t.method)];
  const std::string& scene = protocol_.scenes[static_cast<std::size_t>(t.scene)].name;
  const std::string& question = protocol_.scenes[static_cast<std::size_t>(t.question)].name;
  const double looks = std::max(1, strength_.looks);
  const auto settings = settings_to_json(settings_groups(method.settings));
  return {{"kind", "trial"},
          {"trial", done_ + 1},
          {"method", method.name},
          {"scene", scene},
          {"question", question},
          {"answer", yes ? 1 : 0},
          {"correct", yes == (t.scene == t.question) ? 1 : 0},
          {"response_s", rounded(sight.time - since_, 3)},
          {"stimulus", stimulus_hash(settings, scene)},
          {"gate", gate_json(gate_at_onset_)},
          {"anyway", anyway_},
          {"target_mn", rounded(1e3 * strength_.target / looks, 4)},
          {"rendered_mn", rounded(1e3 * strength_.rendered / looks, 4)},
          {"hand_gone_s", rounded(hand_gone_, 3)},
          {"hand", hand_}};
}

void StudySession::add_strength(const Trial& trial, double target, double rendered) {
  const auto place = static_cast<std::size_t>(trial.method) * protocol_.scenes.size() +
                     static_cast<std::size_t>(trial.scene);
  strengths_[place].target += target;
  strengths_[place].rendered += rendered;
  ++strengths_[place].looks;
}

std::string StudySession::answer(bool yes, const StudySight& sight) {
  const ResponseLine line = trial_line(yes, sight);
  const double looks = std::max(1, strength_.looks);
  add_strength(trial(), strength_.target / looks, strength_.rendered / looks);
  if (protocol_.trials.feedback) feedback_ = line["correct"] == 1;
  write(line, sight);
  last_ = yes;
  ++done_;
  if (done_ == trials_.size()) {
    enter(StudyPhase::Done, sight.time);
    write({{"kind", "end"}, {"strengths", strengths()}}, sight);
  } else if (starts_method()) {
    begin_method(sight.time);
  } else {
    const int every = protocol_.trials.break_every;
    const bool rests = every > 0 && done_ % static_cast<std::size_t>(every) == 0;
    enter(rests ? StudyPhase::Break : StudyPhase::Settling, sight.time);
  }
  return problem_;
}

std::string StudySession::correct(const StudySight& sight) {
  const Trial& t = trials_[done_ - 1];
  last_ = !*last_;
  const bool right = *last_ == (t.scene == t.question);
  if (protocol_.trials.feedback) feedback_ = right;
  return write({{"kind", "correction"},
                {"trial", done_},
                {"answer", *last_ ? 1 : 0},
                {"correct", right ? 1 : 0}},
               sight);
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
      return {};
    case Do::Answer:
      if (phase_ != StudyPhase::Presenting) return refuse();
      return answer(act.yes, sight);
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

std::string StudySession::strengths() const {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Strength& s : strengths_) {
    if (s.looks == 0) continue;
    least = std::min(least, s.rendered / s.looks);
    most = std::max(most, s.rendered / s.looks);
  }
  if (!(most > 0.0) || most - least <= protocol_.trials.strength * most) return {};
  return fmt::format(
      "Conditions differ in strength by {:.0f} %, and the protocol lets {:.0f} % pass: strength "
      "may "
      "be a cue.",
      100.0 * (most - least) / most, 100.0 * protocol_.trials.strength);
}

}  // namespace prostm
