#include "prostm/pipeline/detail/steering.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "prostm/core/stage_timer.hpp"

namespace prostm {
namespace {

constexpr double kShowPeriod = 0.015, kTellPeriod = 0.25;  // [s]
constexpr double kLookBack = 5e-3;                         // one period of AM at 200 Hz [s]

}  // namespace

Steering::Steering(LiveLink& link, Pipeline& pipeline) : link_(link), pipeline_(pipeline) {
  state_.settings = link.settings;
  planned_with_ = std::make_shared<const PipelineSettings>(link.settings.pipeline);
  link_.snapshots.use(planned_with_);
  publish_state();
}

void Steering::attend() {
  using Kind = LiveCommand::Kind;
  LiveSettings wanted = state_.settings;
  std::vector<std::uint32_t> senders;  // senders of settings that are not yet applied
  const auto settle = [&] {
    if (!senders.empty()) apply(wanted, senders);
    senders.clear();
    wanted = state_.settings;
  };
  LiveCommand command;
  while (link_.control.next(command)) {
    // successive settings are applied together: a slider sends many
    if (command.kind != Kind::Set) settle();
    switch (command.kind) {
      case Kind::Set:
        run_controls()[static_cast<std::size_t>(command.control)].set(wanted, command.value);
        senders.push_back(command.sender);
        break;
      case Kind::Configure:
        wanted = *command.settings;
        senders.push_back(command.sender);
        break;
      case Kind::Play:
        state_.playing = true;
        break;
      case Kind::Pause:
        state_.playing = false;
        break;
      case Kind::Step:
        state_.playing = false;
        ++updates_asked_;
        break;
      case Kind::Seek:
        pipeline_.world_stage().hands().seek(command.value);
        if (!state_.playing) ++updates_asked_;  // so that the new position is shown
        break;
      case Kind::TrackerPose:
        pipeline_.world_stage().set_tracker_pose(command.X_DT);
        if (link_.hands != nullptr) link_.hands->set_tracker_pose(command.X_DT);
    }
  }
  settle();
  publish_state();
}

void Steering::play() {
  state_.playing = true;
  updates_asked_ = 0;
  publish_state();
}

bool Steering::next_update() {
  if (updates_asked_ == 0) return false;
  --updates_asked_;
  return true;
}

void Steering::apply(const LiveSettings& wanted, const std::vector<std::uint32_t>& senders) {
  try {
    change(wanted);
  } catch (const std::exception& error) {
    for (const std::uint32_t sender : senders) link_.control.refuse(sender, error.what());
  }
}

void Steering::change(const LiveSettings& wanted) {
  const LiveSettings& held = state_.settings;
  WorldStage* stage = &pipeline_.world_stage();
  std::unique_ptr<HandSwitch> hands;
  const bool other_hands = wanted.source != held.source ||
                           wanted.pipeline.track.prediction != held.pipeline.track.prediction;
  if (other_hands) {
    hands = link_.make_hands(wanted.source, wanted.pipeline);
    hands->set_tracker_pose(stage->tracker_pose());
    const double at = stage->hands().recording_time();
    if (wanted.source == held.source && std::isfinite(at)) hands->seek(at);
  }
  pipeline_.reconfigure(wanted.pipeline);
  if (hands) {
    link_.hands = hands.get();
    pipeline_.world_stage().set_hands(std::move(hands));
  }
  state_.settings = wanted;
  planned_with_ = std::make_shared<const PipelineSettings>(wanted.pipeline);
  link_.snapshots.use(planned_with_);
}

void Steering::publish_state() {
  const HandSource& hands = pipeline_.world_stage().hands();
  state_.recording_length = hands.recording_length();
  state_.tracker = hands.tracker_status();
  state_.X_DT = pipeline_.world_stage().tracker_pose();
  link_.control.publish(state_);
  told_ = steady_now();
}

void Steering::show(double time, std::int64_t steps, std::int64_t plans, bool fading,
                    const Advice& advice) {
  const double t = steady_now();
  if (t - shown_ < kShowPeriod) return;
  shown_ = t;
  step_rate_.add(t, steps);
  plan_rate_.add(t, plans);
  RunSnapshot& run = link_.snapshots.run_draft();
  run.time = time;
  run.world_rate = step_rate_.rate();
  run.plan_rate = plan_rate_.rate();
  run.paused = !state_.playing;
  if (link_.page_hand) run.page_hand = link_.page_hand->report();
  run.fading = fading;
  run.device_lost = pipeline_.device().status() == DeviceStatus::Vanished;
  run.advice = advice;
  run.device = pipeline_.device_stats();
  run.emit = pipeline_.emit_stats();
  run.full_scale_pressure = pipeline_.plans().full_scale_pressure();
  run.intensity = intensity();
  link_.snapshots.publish_run();
  // only trackers change without a command
  if (state_.tracker && t - told_ > kTellPeriod) publish_state();
}

double Steering::intensity() const {
  if (!link_.snapshots.watched()) return 0.0;
  const Device& device = pipeline_.device();
  if (device.played() == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<std::int64_t>(kLookBack * device.info().sample_rate);
  const std::int64_t played = device.samples();
  if (played < n) return 0.0;
  double strongest = 0.0;
  for (const FocusSample& sample : device.played()->read_back(played - n, n))
    strongest = std::max(strongest, static_cast<double>(sample.intensity));
  return strongest;
}

}  // namespace prostm
