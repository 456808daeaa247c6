#include "prostm/viewer/pipeline_view.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "prostm/core/input_error.hpp"
#include "prostm/viewer/detail/command_queue.hpp"
#include "prostm/viewer/detail/frame_maker.hpp"
#include "prostm/viewer/detail/settings_text.hpp"
#include "prostm/viewer/detail/state_json.hpp"

namespace prostm {
namespace {

using viewer::Json;

constexpr const char* kNoTracker = "only a tracker can be calibrated";

}  // namespace

struct PipelineView::Impl {
  Impl(LiveLink& l, ViewHello h)
      : link(l),
        hello(std::move(h)),
        start(l.settings),
        frames(l.snapshots, *l.mute),
        commands(l.control) {}

  LiveLink& link;
  const ViewHello hello;
  const LiveSettings start;  // initial settings of the run
  viewer::FrameMaker frames;
  viewer::CommandQueue commands;
  std::uint32_t hand_holder = 0;  // page that holds the hand; 0: none
  bool known = false;             // whether the run has begun
  PageHandState told_hand = PageHandState::Free;
  std::uint32_t told_holder = 0;
  Advice told_advice;
  std::optional<CalibrationGuide> calibration;
  std::uint32_t calibrator = 0;       // last page in control; 0: it has disconnected
  Pose pose_kept = Pose::Identity();  // tracker pose to restore: the initial or last saved one
  bool calibration_saved = false, calibration_changed = false;

  std::string ask(const LiveCommand& command) {
    const bool takes = commands.add(command, viewer::CommandQueue::Clock::now());
    return takes ? "" : "the run is busy with earlier commands; try again";
  }
  std::string take(std::uint32_t page, const SetMessage& m);
  std::string take(std::uint32_t page, const TransportMessage& m);
  std::string take(std::uint32_t page, const HandMessage& m);
  std::string take(std::uint32_t page, const CalibrationMessage& m);
  std::string take(std::uint32_t, const MuteMessage& m) {
    link.mute->set(MuteReason::Person, m.on);
    return {};
  }
  std::string begin_calibration();
  std::string take_mark(int mark);
  std::string solve_calibration(std::uint32_t page);
  std::string save_calibration();
  std::string end_calibration(std::uint32_t page);
  void look_at_finger();
  std::string take(std::uint32_t, const RateMessage&) { return {}; }
  std::string take(std::uint32_t, const StudyAct&) { return "this run is not a study"; }
  std::string take(std::uint32_t, const PageReport&) { return "this run is not a study"; }
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
    // a page cannot release another page's hand
    if (page != hand_holder) return {};
    link.page_hand->release(m.hidden);
    hand_holder = 0;
    return {};
  }
  // also while it has lapsed: two pages with slow timers must not alternate
  const bool anothers = hand_holder != 0 && hand_holder != page;
  if (anothers && !m.take) return "another page has the hand; switch it on here to take it";
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
  // a restarted calibration restores the kept pose, not a tried one
  if (!calibration) pose_kept = state.X_DT;
  calibration.emplace(hello.transducers);
  calibration_saved = false;
  // a finger will touch the array
  link.mute->set(MuteReason::Calibration, true);
  return {};
}

std::string PipelineView::Impl::take_mark(int mark) {
  const RunSnapshot& run = link.snapshots.run();
  if (!link.control.state().tracker) return kNoTracker;
  if (run.page_hand_in_charge()) return "switch the page's hand off first";
  if (run.paused) return "the run is paused; resume it first";
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

/// Ends a calibration and discards a pose that was not saved.
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
  if (!calibration || link.snapshots.run().page_hand_in_charge()) return;
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

std::string PipelineView::hello(std::uint32_t page, Room) {
  const ViewHello& h = impl_->hello;
  Json transducers = Json::array();
  for (const Vec3& p : h.transducers) transducers.push_back(viewer::millimetres(p));
  return Json{
      {"type", "hello"},
      {"version", kWireVersion},
      {"page", page},
      {"prostm", h.version},
      {"device", h.device},
      {"numbers", view_number_names()},
      {"array", {{"name", h.array}, {"transducers_mm", transducers}}},
      {"box_mm", {{"origin", viewer::millimetres(h.box_corner)}, {"edge", 1e3 * h.box_edge}}},
      {"sensation",
       {{"below_db", h.level_below}, {"above_db", h.level_above}, {"sound", h.sound_source}}}}
      .dump();
}

bool PipelineView::refresh_state(Room room, std::string& out) {
  if (room == Room::Guest) return false;
  Impl& i = *impl_;
  // no page is left to end it
  if (i.calibration && i.calibrator == 0 && i.end_calibration(0).empty())
    i.calibration_changed = true;
  const auto now = viewer::CommandQueue::Clock::now();
  const bool fresh = i.link.control.refresh();
  if (fresh) i.commands.answered(now);
  i.commands.hand_over(now);
  const PageHandState hand = i.link.snapshots.run().page_hand.state;
  i.known = i.known || fresh;  // before the run begins there is no state
  const bool same_hand = hand == i.told_hand && i.hand_holder == i.told_holder;
  const Advice advice = i.link.snapshots.run().advice;
  const bool same = same_hand && advice == i.told_advice;
  if (!i.known || (!fresh && same && !i.calibration_changed)) return false;
  i.calibration_changed = false;
  i.told_hand = hand;
  i.told_holder = i.hand_holder;
  i.told_advice = advice;
  const LiveState& state = i.link.control.state();
  const Json json = {
      {"type", "state"},
      {"controls", viewer::controls_json(state.settings, i.start)},
      {"transport", viewer::transport_json(state, hand, i.hand_holder)},
      {"rates", viewer::rates_json(state.settings.pipeline, advice)},
      {"settings", viewer::changed_settings(state.settings.pipeline)},
      {"tracker", viewer::tracker_json(state.tracker)},
      {"calibration", viewer::calibration_json(i.calibration, i.calibration_saved, i.link.pose_file,
                                               i.link.mute->on(MuteReason::Calibration))}};
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
  if (page == impl_->hand_holder) {
    impl_->link.page_hand->release();
    impl_->hand_holder = 0;
  }
  if (page == impl_->calibrator) impl_->calibrator = 0;
}

}  // namespace prostm
