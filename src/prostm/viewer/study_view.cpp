#include "prostm/viewer/study_view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "prostm/core/stage_timer.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/pipeline/smoke/smoke_world.hpp"
#include "prostm/study/live/presented.hpp"
#include "prostm/study/task/task.hpp"
#include "prostm/viewer/detail/state_json.hpp"

namespace prostm {
namespace {

using viewer::Json;

/// A visible page reports twice a second; one without a report for this time has stopped [s].
constexpr double kReportAge = 3.0;

/// Whether the problem concerns the hand, so that it does not reveal the stimulus.
bool is_of_hand(GateProblem problem) {
  return problem > GateProblem::None && problem < GateProblem::Maxima;
}

/// The picture of a scene: for each jet of smoke x, y and radius, in mm, on a flat hand above the
/// array.
Json jets_json(const std::string& scene, const PipelineSettings& settings) {
  Json jets = Json::array();
  if (!is_smoke(settings)) return jets;
  for (const SmokeJet& jet : scene_from_name(scene).smoke.jets)
    jets.push_back({1e3 * jet.centre.x(), 1e3 * jet.centre.y(), 1e3 * jet.radius});
  return jets;
}

/// The form of answers, from which both pages make their buttons and keys.
Json controls_json(const Task& task) {
  const TaskTraits& traits = task.traits();
  return {{"form", name_of(traits.form)},
          {"words", traits.words},
          {"spoken", traits.spoken},
          {"intervals", traits.intervals}};
}

/// The number of the answer that pages receive as true: yes, or the second interval.
int truth_of(const Task& task) {
  return task.traits().form == AnswerForm::Interval ? 2 : 1;
}

double rendered_force(const ViewFrame& frame) {
  double force = 0.0;  // [N]
  for (std::uint32_t i = 0; i < frame.field_count; ++i) {
    const ViewField& field = frame.fields[i];
    double sum = 0.0;
    for (const std::uint16_t pressure : field.rendered) sum += pressure;
    force += sum * static_cast<double>(field.scale) / 65535.0 * static_cast<double>(field.cell) *
             static_cast<double>(field.cell);
  }
  return force;
}

Pose pose_of(const ViewJoint& joint) {
  using Joint = Eigen::Matrix<float, 8, 1>;
  const Eigen::Matrix<double, 8, 1> values = Eigen::Map<const Joint>(joint.data()).cast<double>();
  Pose pose = Pose::Identity();
  pose.translation() = values.head<3>();
  pose.linear() = Quat(values[6], values[3], values[4], values[5]).normalized().toRotationMatrix();
  return pose;
}

bool is_allowed(Room room, const StudyAct& act, AnswersFrom answers) {
  using Do = StudyAct::Do;
  if (room == Room::Main) return true;
  if (act.what == Do::Answer || act.what == Do::Tune || act.what == Do::Accept)
    return answers == AnswersFrom::Participant;
  return act.what == Do::Consent || act.what == Do::About || act.what == Do::Explore ||
         act.what == Do::Withdraw;
}

/// Whether a plan was made with these settings.
bool is_planned_with(const PipelineSettings& plan, const PipelineSettings& settings) {
  return plan.scene == settings.scene && plan.method == settings.method &&
         plan.plan == settings.plan && plan.am == settings.am && plan.emit == settings.emit;
}

}  // namespace

StudySight study_time() {
  StudySight sight;
  sight.time = steady_now();
  sight.utc =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return sight;
}

StudyView::StudyView(LiveLink& link, ViewHello hello, StudySession& session,
                     std::optional<Rehearsal> rehearsal, MarkerSender* markers)
    : link_(link),
      run_(link, std::move(hello)),
      session_(session),
      rehearsal_(std::move(rehearsal)),
      markers_(markers) {
  link_.snapshots.watch(true);  // the session needs snapshots, even without pages
  link_.mute->set(MuteReason::Study, true);
}

StudySight StudyView::sight() {
  StudySight s = study_time();
  const PlanSnapshot& plan = link_.snapshots.plan();
  s.in_force = is_asked(session_.wanted()) &&
               link_.control.state().settings.version == settings_->version && plan.settings &&
               is_planned_with(*plan.settings, settings_->pipeline);
  if (frame_.hand_count > 0) s.palm = pose_of(frame_.hands[0].joints[0]);
  s.gate = plan.gate;
  const double force = static_cast<double>(frame_.numbers[kForceMn]);
  s.target_force = force > 0.0 ? 1e-3 * force : 0.0;
  s.rendered_force = rendered_force(frame_);
  s.played = played_of(plan);
  s.page = participants_page(s.time);
  return s;
}

/// Returns the page with the fewest unmet needs. The last report of a hidden page remains valid,
/// since browsers slow down its timers. A rehearsal needs no page.
ParticipantPage StudyView::participants_page(double time) const {
  const PageReport full{true, PageNoise::Playing, true};
  if (rehearsal_) return {true, full};
  const PageTask whole{true, PageNoise::Playing, true};
  ParticipantPage best;
  for (const auto& [number, page] : pages_) {
    if (page.room != Room::Guest) continue;
    ParticipantPage now{true, page.report};
    if (now.report && now.report->visible && time - page.reported > kReportAge) now.report.reset();
    if (!best.open || missing(whole, now).count() < missing(whole, best).count()) best = now;
  }
  return best;
}

void StudyView::tick() {
  run_.refresh(frame_, news_);
  link_.control.refresh();
  LiveRefusal refusal;
  while (link_.control.next_refusal(refusal)) problem_ = refusal.sentence;
  const StudySight now = sight();
  Marker marker;
  while (markers_ != nullptr && markers_->next(marker)) session_.note(markers_->line(marker), now);
  played_ = now.played;
  if (sounds_ && played_ && markers_ != nullptr) markers_->tell(*played_);
  present(session_.look(now));
  std::string sentence;
  while (session_.next_news(sentence)) news_for_terminal_.push(sentence);
  if (!rehearsal_) return;
  const auto act = rehearsal_->act(session_, now.time);
  if (act) session_.take(*act, now);
  present(session_.wanted());
  if (rehearsal_->is_done()) closed_.store(true, std::memory_order_relaxed);
}

bool StudyView::is_asked(const StudyWanted& wanted) const {
  return settings_ && wanted.method == asked_.method && wanted.scene == asked_.scene &&
         wanted.level == asked_.level && wanted.standard == asked_.standard;
}

/// Sets or lifts the study's mute. The presentation must be set before.
void StudyView::let_sound(bool sound) {
  if (sound && !sounds_ && markers_ != nullptr)
    markers_->present(presentation_of(session_, ++presentations_), played_);
  sounds_ = sound;
  link_.mute->set(MuteReason::Study, !sound);
}

/// Requests the wanted stimulus from the run, if it has changed.
void StudyView::present(const StudyWanted& wanted) {
  let_sound(wanted.sound);
  if (session_.closed()) closed_.store(true, std::memory_order_relaxed);
  if (is_asked(wanted)) return;
  auto settings = std::make_shared<LiveSettings>(link_.settings);
  settings->pipeline = settings_for(session_.protocol(), wanted);
  settings->pipeline.plan.widths = link_.settings.pipeline.plan.widths;
  settings->version = settings_ ? settings_->version + 1 : 1;
  LiveCommand command{LiveCommand::Kind::Configure};
  command.settings = settings;
  if (!link_.control.ask(command)) return;  // busy: retry at the next tick
  settings_ = std::move(settings);
  asked_ = wanted;
  problem_.clear();
}

void StudyView::refresh(ViewFrame& frame, ViewNews& news) {
  const std::uint32_t sequence = frame.sequence;
  frame = frame_;
  frame.sequence = sequence;
  news = news_;
  if (!session_.protocol().study.blind) return;
  // in training, a participant sees only smoke and hands; the rest would reveal the method
  frame.path_count = frame.field_count = 0;
  frame.gate.reset();
  std::fill(frame.numbers.begin(), frame.numbers.end(), std::numeric_limits<float>::quiet_NaN());
}

bool StudyView::shows_frames(Room room) const {
  if (room == Room::Main) return !session_.protocol().study.blind;
  return session_.phase() == StudyPhase::Training && session_.wanted().picture;
}

std::string StudyView::hello(std::uint32_t page, Room room) {
  pages_[page].room = room;
  return run_.hello(page, room);
}

bool StudyView::refresh_state(Room room, std::string& state) {
  if (room == Room::Main) tick();
  const Json json = room == Room::Main ? experimenter() : participant();
  state = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string& told = told_[static_cast<std::size_t>(room)];
  if (state == told) return false;
  told = state;
  return true;
}

/// The part for both pages, which does not depend on the stimulus. `interval` counts intervals,
/// regardless of which one has the level.
Json StudyView::both(const char* room) const {
  const Protocol& p = session_.protocol();
  Json json = {{"type", "study"},
               {"room", room},
               {"title", p.study.title},
               {"phase", name_of(session_.phase())},
               {"done", session_.trials_done()},
               {"trials", session_.course().most()},
               {"open", session_.course().is_open()},
               {"task", p.trials.task->name()},
               {"controls", controls_json(*p.trials.task)},
               {"interval", session_.interval()},
               {"takes_answer", session_.takes_answer()},
               {"training_left_s", std::ceil(session_.training_left())},
               {"practice", session_.practice_trial()},
               {"explored", session_.explored()},
               {"scenes", Json::array()},
               {"answers", name_of(p.trials.answers)},
               {"hand", frame_.hand_count > 0}};
  for (const StudyScene& scene : p.scenes) json["scenes"].push_back(scene.name);
  return json;
}

/// The reason for the wait, without what would reveal the stimulus.
std::string StudyView::waits_without_stimulus() const {
  const auto& gate = session_.gate();
  const bool is_of_field = gate && !gate->pass && !is_of_hand(gate->finding.problem);
  if (session_.waits_for().empty() || !is_of_field) return session_.waits_for();
  return "The smoke on the hand is not yet as the scene intends. Hold the hand flat, still and "
         "over the middle of the array.";
}

Json StudyView::experimenter() const {
  const Protocol& p = session_.protocol();
  const StudyPhase phase = session_.phase();
  Json json = both("experimenter");
  json["participant"] = session_.participant();
  json["blind"] = p.study.blind;
  // in a blind study a catch trial looks like any other
  const bool hides = p.study.blind && session_.presents_nothing();
  json["output"] = hides ? !link_.mute->on_besides(MuteReason::Study) : !link_.mute->on();
  json["waits_for"] = session_.waits_for();
  json["needs"] = session_.page_problem();
  json["bound"] = session_.at_bound();
  json["strengths"] = session_.strengths();
  json["practice_failed"] = session_.practice_failed();
  json["problem"] = session_.problem().empty() ? problem_ : session_.problem();
  json["last"] = nullptr;
  if (const auto last = session_.last_answer()) json["last"] = *last == truth_of(*p.trials.task);
  json["question"] = nullptr;
  json["condition"] = nullptr;
  if (p.study.blind) json["waits_for"] = waits_without_stimulus();
  if (session_.course().is_done()) return json;
  const Trial& trial = session_.trial();
  if (phase == StudyPhase::Settling || phase == StudyPhase::Presenting)
    json["question"] = session_.question();
  if (!p.study.blind && !session_.presents_nothing()) {
    json["condition"] = {{"method", p.methods[static_cast<std::size_t>(trial.method)].name},
                         {"scene", p.scenes[static_cast<std::size_t>(trial.scene)].name}};
    if (trial.level) json["condition"]["level"] = *trial.level;
  }
  return json;
}

Json StudyView::participant() const {
  const Protocol& p = session_.protocol();
  const StudyPhase phase = session_.phase();
  Json json = both("participant");
  json["consent"] = p.study.consent;
  json["noise"] = p.trials.noise;
  json["waits_for"] = phase == StudyPhase::Settling ? waits_without_stimulus() : "";
  json["feedback"] = nullptr;
  if (session_.feedback()) json["feedback"] = *session_.feedback();
  json["question"] = nullptr;
  if (phase == StudyPhase::Presenting) {
    const StudyScene& asked = p.scenes[static_cast<std::size_t>(session_.trial().question)];
    const bool is_check = session_.extra() && session_.extra()->kind == ExtraKind::Attention;
    const bool pictured = p.trials.task->traits().pictured && !is_check;
    json["question"] = {
        {"text", session_.question()},
        {"jets_mm", pictured ? jets_json(asked.name, p.methods.front().settings) : Json::array()}};
  }
  return json;
}

std::string StudyView::act(Room room, const StudyAct& act) {
  if (!is_allowed(room, act, session_.protocol().trials.answers))
    return "only the experimenter can do that";
  const std::string problem = session_.take(act, sight());
  present(session_.wanted());
  return problem;
}

std::string StudyView::take_report(std::uint32_t page, const PageReport& report) {
  OpenPage& open = pages_[page];
  if (open.room == Room::Main) return "only the participant's page reports";
  open.report = report;
  open.reported = steady_now();
  return {};
}

std::string StudyView::take(std::uint32_t page, const PageMessage& message) {
  const Room room = pages_[page].room;
  if (const auto* report = std::get_if<PageReport>(&message)) return take_report(page, *report);
  if (const auto* asked = std::get_if<StudyAct>(&message)) return act(room, *asked);
  const bool steers_hand =
      std::holds_alternative<HandMessage>(message) || std::holds_alternative<MuteMessage>(message);
  if (room == Room::Main && steers_hand) return run_.take(page, message);
  return "the settings of a study are set by its protocol";
}

bool StudyView::next_refusal(std::uint32_t&, std::string&) {
  return false;  // refusals of the run are reported by the session
}

void StudyView::forget(std::uint32_t page) {
  run_.forget(page);
  pages_.erase(page);
}

}  // namespace prostm
