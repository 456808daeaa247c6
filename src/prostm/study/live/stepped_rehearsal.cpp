#include "prostm/study/live/stepped_rehearsal.hpp"

#include <limits>
#include <numeric>
#include <utility>

#include "prostm/study/live/presented.hpp"

namespace prostm {
namespace {

/// Total force of the field that a plan renders [N].
double force_of(const RenderedPlan& rendered, const TargetFrame& target) {
  double force = 0.0;
  for (std::size_t i = 0; i < target.patches.size(); ++i) {
    const std::vector<double>& field = rendered.field[i];
    const double cell = target.patches[i].cell;
    force += std::accumulate(field.begin(), field.end(), 0.0) * cell * cell;
  }
  return force;
}

Pose palm_joint(const Hand& hand) {
  Pose pose = Pose::Identity();
  pose.translation() = hand.position[kPalm];
  pose.linear() = hand.orientation[kPalm].toRotationMatrix();
  return pose;
}

/// Whether two stimuli have the same settings, whatever is heard and seen of them.
bool are_alike(const StudyWanted& a, const StudyWanted& b) {
  return a.method == b.method && a.scene == b.scene && a.level == b.level &&
         a.standard == b.standard;
}

}  // namespace

SteppedRehearsal::SteppedRehearsal(Pipeline& pipeline, std::shared_ptr<Mute> mute,
                                   StudySession& session, Rehearsal rehearsal,
                                   const StudySight& now)
    : pipeline_(pipeline),
      mute_(std::move(mute)),
      session_(session),
      rehearsal_(std::move(rehearsal)),
      began_(now) {
  present(session_.wanted());
}

bool SteppedRehearsal::step() {
  const bool planned = pipeline_.step(1.0 / pipeline_.settings().world_rate);
  if (planned) take_plan();
  const StudySight now = sight();
  session_.look(now);
  if (const auto act = rehearsal_.act(session_, now.time)) session_.take(*act, now);
  present(session_.wanted());
  return planned;
}

void SteppedRehearsal::take_plan() {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  snapshots_.plan(pipeline_.contact(), pipeline_.plan(), kUnknown);
  snapshots_.refresh_plan();
  render(snapshots_.plan(), rendered_);
  rendered_force_ = force_of(rendered_, snapshots_.plan().target);
}

StudySight SteppedRehearsal::sight() {
  constexpr ParticipantPage kWhole{true, PageReport{true, PageNoise::Playing, true}};
  const PlanSnapshot& plan = snapshots_.plan();
  StudySight now;
  now.time = began_.time + pipeline_.time();
  now.utc = began_.utc + pipeline_.time();
  now.in_force = plan.settings == settings_;
  const auto& hands = pipeline_.contact().hands.hands;
  if (!hands.empty()) now.palm = palm_joint(hands.front());
  now.gate = plan.gate;
  now.played = played_of(plan);
  now.page = kWhole;
  now.target_force = rendered_.force;
  now.rendered_force = rendered_force_;
  return now;
}

void SteppedRehearsal::present(const StudyWanted& wanted) {
  mute_->set(MuteReason::Study, !wanted.sound);
  if (presented_ && are_alike(*presented_, wanted)) return;
  const PipelineSettings settings = settings_for(session_.protocol(), wanted);
  pipeline_.reconfigure(settings);
  settings_ = std::make_shared<const PipelineSettings>(settings);
  snapshots_.use(settings_);
  presented_ = wanted;
}

}  // namespace prostm
