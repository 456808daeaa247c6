#include "prostm/viewer/pipeline_view.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/viewer/detail/frame_maker.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNoTracker = "only hands of a tracker have a pose that can be found";

Json millimetres(const Vec3& p) {
  return {1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()};
}

std::string text(std::string_view view) {
  return std::string(view);
}

Json control_json(const RunControl& control, const LiveSettings& settings) {
  Json json = {
      {"id", text(control.id)}, {"group", text(control.group)}, {"label", text(control.label)}};
  const double value = control.get(settings);
  switch (control.kind) {
    case ControlKind::Switch:
      json["kind"] = "switch";
      json["value"] = value != 0.0;
      break;
    case ControlKind::Number:
      json["kind"] = "number";
      json["value"] = value;
      json["min"] = control.low;
      json["max"] = control.high;
      json["step"] = control.step;
      break;
    case ControlKind::Choice:
      json["kind"] = "choice";
      json["value"] = text(control.choices[static_cast<std::size_t>(value)].value);
      json["choices"] = Json::array();
      for (std::size_t i = 0; i < control.choices.size(); ++i) {
        if (control.available != nullptr && !control.available(settings, i)) continue;
        json["choices"].push_back(
            {{"value", text(control.choices[i].value)}, {"label", text(control.choices[i].label)}});
      }
  }
  json["help"] = text(control.help);
  if (!control.unit.empty()) json["unit"] = text(control.unit);
  json["enabled"] = control.enabled(settings);
  return json;
}

Json transport_json(const LiveState& state, bool page_hand) {
  Json json = {{"playing", state.playing}, {"recording", nullptr}};
  if (state.recording_length > 0.0)
    json["recording"] = {{"length_s", state.recording_length}, {"seekable", true}};
  json["source"] = page_hand ? "page" : state.settings.source;
  json["base"] = state.settings.source;
  return json;
}

Json tracker_json(const std::optional<TrackerStatus>& tracker) {
  if (!tracker) return nullptr;
  return {{"connected", tracker->connected}, {"sentence", tracker->sentence},
          {"frames", tracker->frames},       {"dropped", tracker->dropped},
          {"repeated", tracker->repeated},   {"unsure", tracker->unsure},
          {"frozen", tracker->frozen}};
}

Json calibration_json(const std::optional<CalibrationGuide>& steps, bool saved,
                      const std::string& file, bool muted) {
  if (!steps) return nullptr;
  Json json = {{"marks", Json::array()}, {"residual_mm", nullptr}};
  for (const CalibrationMark& mark : steps->marks()) {
    Json one = {{"name", mark.name},
                {"p_mm", millimetres(mark.p_D)},
                {"taken", mark.taken},
                {"spread_mm", nullptr}};
    if (mark.taken) one["spread_mm"] = 1e3 * mark.spread;
    json["marks"].push_back(one);
  }
  if (steps->result()) json["residual_mm"] = 1e3 * steps->result()->rms;
  json["file"] = file;
  json["saved"] = saved;
  json["sentence"] = steps->sentence();
  json["muted"] = muted;
  return json;
}

}  // namespace

struct PipelineView::Impl {
  Impl(LiveLink& l, ViewHello h) : link(l), hello(std::move(h)), frames(l.snapshots) {}

  LiveLink& link;
  const ViewHello hello;
  viewer::FrameMaker frames;
  std::uint32_t hand_holder = 0;  // the page that holds the hand, 0: none
  bool known = false;             // the run has begun
  bool page_hand = false;         // as told
  std::optional<CalibrationGuide> calibration;
  std::uint32_t calibrator = 0;       // the page that it listened to last, 0: that one is gone
  Pose pose_kept = Pose::Identity();  // of the tracker: when it began, or what was saved since
  bool calibration_saved = false, calibration_changed = false;

  std::string ask(const LiveCommand& command) const {
    return link.control.ask(command) ? "" : "the run is busy with what was asked before; try again";
  }
  std::string take(std::uint32_t page, const SetMessage& m);
  std::string take(std::uint32_t page, const TransportMessage& m);
  std::string take(std::uint32_t page, const HandMessage& m);
  std::string take(std::uint32_t page, const CalibrationMessage& m);
  std::string begin_calibration();
  std::string take_mark(int mark);
  std::string solve_calibration(std::uint32_t page);
  std::string save_calibration();
  std::string end_calibration(std::uint32_t page);
  void look_at_finger();
  std::string take(std::uint32_t, const RateMessage&) { return {}; }
};

std::string PipelineView::Impl::take(std::uint32_t page, const SetMessage& m) {
  const int index = control_index(m.id);
  if (index < 0) return "there is no control \"" + m.id + "\"";
  try {
    LiveCommand command{LiveCommand::Kind::Set, page, index};
    const ControlValue value = std::visit([](const auto& v) -> ControlValue { return v; }, m.value);
    command.value = control_number(run_controls()[static_cast<std::size_t>(index)], value,
                                   link.control.state().settings);
    return ask(command);
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string PipelineView::Impl::take(std::uint32_t page, const TransportMessage& m) {
  LiveCommand command;
  command.sender = page;
  switch (m.what) {
    case TransportMessage::Do::Play:
      command.kind = LiveCommand::Kind::Play;
      break;
    case TransportMessage::Do::Pause:
      command.kind = LiveCommand::Kind::Pause;
      break;
    case TransportMessage::Do::Step:
      command.kind = LiveCommand::Kind::Step;
      break;
    case TransportMessage::Do::Seek:
      if (!(link.control.state().recording_length > 0.0))
        return "these hands have no recording to seek in";
      command.kind = LiveCommand::Kind::Seek;
      command.value = m.time;
  }
  return ask(command);
}

std::string PipelineView::Impl::take(std::uint32_t page, const HandMessage& m) {
  if (m.release) {
    // letting go of what another page holds would be rude
    if (page == hand_holder) link.page_hand->release();
    return {};
  }
  hand_holder = page;
  PagePose pose;
  pose.p_D = {m.palm[0], m.palm[1], m.palm[2]};
  pose.yaw = m.yaw;
  pose.pitch = m.pitch;
  pose.roll = m.roll;
  pose.closure = m.closure;
  pose.side = m.left ? Side::Left : Side::Right;
  return link.page_hand->place(pose) ? "" : "the page's hand cannot be there";
}

std::string PipelineView::Impl::begin_calibration() {
  const LiveState& state = link.control.state();
  if (!state.tracker) return kNoTracker;
  // one that begins anew keeps what the one before kept, not what it tried
  if (!calibration) pose_kept = state.X_DT;
  calibration.emplace(hello.transducers);
  calibration_saved = false;
  // a finger is going to touch the array
  link.mute->set(MuteReason::Calibration, true);
  return {};
}

std::string PipelineView::Impl::take_mark(int mark) {
  const RunSnapshot& run = link.snapshots.run();
  if (!link.control.state().tracker) return kNoTracker;
  if (run.page_hand) return "let go of the page's hand first";
  if (run.paused) return "the run is paused; let it go on first";
  return calibration->take(mark);
}

std::string PipelineView::Impl::solve_calibration(std::uint32_t page) {
  const std::string wrong = calibration->solve();
  if (!wrong.empty()) return wrong;
  calibration_saved = false;
  LiveCommand pose{LiveCommand::Kind::TrackerPose, page};
  pose.X_DT = calibration->result()->X_DT;
  return ask(pose);
}

std::string PipelineView::Impl::save_calibration() {
  if (!calibration->result()) return "there is no pose to save yet; take three marks and solve";
  try {
    link.save_pose(*calibration->result());
  } catch (const InputError& error) {
    return error.what();
  }
  pose_kept = calibration->result()->X_DT;
  calibration_saved = true;
  return {};
}

/// What was not saved does not stay.
std::string PipelineView::Impl::end_calibration(std::uint32_t page) {
  LiveCommand pose{LiveCommand::Kind::TrackerPose, page};
  pose.X_DT = pose_kept;
  const std::string wrong = ask(pose);
  if (!wrong.empty()) return wrong;
  calibration.reset();
  link.mute->set(MuteReason::Calibration, false);
  return {};
}

std::string PipelineView::Impl::take(std::uint32_t page, const CalibrationMessage& m) {
  using Do = CalibrationMessage::Do;
  calibration_changed = true;
  calibrator = page;
  if (m.what == Do::Begin) return begin_calibration();
  if (!calibration) return "no calibration has begun";
  switch (m.what) {
    case Do::Take:
      return take_mark(*m.mark);
    case Do::Solve:
      return solve_calibration(page);
    case Do::Save:
      return save_calibration();
    default:
      return end_calibration(page);
  }
}

void PipelineView::Impl::look_at_finger() {
  if (!calibration || link.snapshots.run().page_hand) return;
  const StepSnapshot& step = link.snapshots.step();
  HandFrame hands = step.hands;
  to_device(step.X_DT.inverse(), hands);  // back into T
  calibration->watch(step.time, hands);
}

PipelineView::PipelineView(LiveLink& link, ViewHello hello)
    : impl_(std::make_unique<Impl>(link, std::move(hello))) {}

PipelineView::~PipelineView() = default;

void PipelineView::watch(bool somebody) {
  impl_->link.snapshots.watch(somebody);
}

void PipelineView::refresh(ViewFrame& frame, ViewNews& news) {
  impl_->frames.refresh(frame, news);
  impl_->look_at_finger();
}

std::string PipelineView::hello() {
  const ViewHello& h = impl_->hello;
  Json transducers = Json::array();
  for (const Vec3& p : h.transducers) transducers.push_back(millimetres(p));
  return Json{{"type", "hello"},
              {"version", kWireVersion},
              {"prostm", h.version},
              {"device", h.device},
              {"numbers", view_number_names()},
              {"array", {{"name", h.array}, {"transducers_mm", transducers}}},
              {"box_mm", {{"origin", millimetres(h.box_corner)}, {"edge", 1e3 * h.box_edge}}}}
      .dump();
}

bool PipelineView::refresh_state(std::string& out) {
  Impl& i = *impl_;
  // nobody is left to end it
  if (i.calibration && i.calibrator == 0 && i.end_calibration(0).empty())
    i.calibration_changed = true;
  const bool fresh = i.link.control.refresh();
  const bool page_hand = i.link.snapshots.run().page_hand;
  i.known = i.known || fresh;  // before the run begins there is nothing to tell
  if (!i.known || (!fresh && page_hand == i.page_hand && !i.calibration_changed)) return false;
  i.calibration_changed = false;
  i.page_hand = page_hand;
  const LiveState& state = i.link.control.state();
  Json json = {{"type", "state"}, {"controls", Json::array()}};
  for (const RunControl& control : run_controls())
    json["controls"].push_back(control_json(control, state.settings));
  json["transport"] = transport_json(state, page_hand);
  json["tracker"] = tracker_json(state.tracker);
  json["calibration"] = calibration_json(i.calibration, i.calibration_saved, i.link.pose_file,
                                         i.link.mute->on(MuteReason::Calibration));
  out = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return true;
}

std::string PipelineView::take(std::uint32_t page, const PageMessage& message) {
  return std::visit([&](const auto& m) { return impl_->take(page, m); }, message);
}

bool PipelineView::next_refusal(std::uint32_t& page, std::string& sentence) {
  LiveRefusal refusal;
  if (!impl_->link.control.next_refusal(refusal)) return false;
  page = refusal.sender;
  sentence = std::move(refusal.sentence);
  return true;
}

void PipelineView::forget(std::uint32_t page) {
  if (page == impl_->hand_holder) impl_->link.page_hand->release();
  if (page == impl_->calibrator) impl_->calibrator = 0;
}

}  // namespace prostm
