#include "prostm/viewer/detail/frame_maker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace prostm::viewer {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMs = 1e3, kMn = 1e3;
constexpr double kHeightScale = 1e-5;  // unit of the skin's heights on the wire [m]

std::array<float, 3> floats(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

void fill_hand(const Hand& hand, ViewHand& out) {
  out.id = static_cast<std::uint32_t>(hand.id);
  out.side = hand.side == Side::Right ? 1 : 0;
  out.confidence = static_cast<float>(hand.confidence);
  for (std::size_t j = 0; j < out.joints.size(); ++j) {
    const auto p = floats(hand.position[j]);
    const Quat& q = hand.orientation[j];
    out.joints[j] = {p[0],
                     p[1],
                     p[2],
                     static_cast<float>(q.x()),
                     static_cast<float>(q.y()),
                     static_cast<float>(q.z()),
                     static_cast<float>(q.w()),
                     static_cast<float>(hand.radius[j])};
  }
}

void fill_smoke(const VolumeView& smoke, ViewSmoke& out) {
  out.n = static_cast<std::uint32_t>(smoke.n);
  out.corner = floats(smoke.p_DF);
  out.edge = static_cast<float>(smoke.edge);
  out.density = smoke.density;
}

std::uint16_t share(double value, double scale) {
  constexpr double kMost = 65535.0;
  return static_cast<std::uint16_t>(std::lround(std::clamp(value / scale, 0.0, 1.0) * kMost));
}

/// @param scale pressure sent as the largest number [Pa].
void fill_field(const TargetField& target, const std::vector<double>& rendered, double scale,
                ViewField& out) {
  constexpr double kHighest = 32767.0;
  out.rows = static_cast<std::uint32_t>(target.rows);
  out.cols = static_cast<std::uint32_t>(target.cols);
  out.cell = static_cast<float>(target.cell);
  out.origin = {static_cast<float>(target.origin.x()), static_cast<float>(target.origin.y())};
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 4; ++col)
      out.X_DP[static_cast<std::size_t>(4 * row + col)] =
          static_cast<float>(target.X_DP.matrix()(row, col));
  out.scale = static_cast<float>(scale);
  out.height_scale = static_cast<float>(kHeightScale);
  const std::size_t n = target.size();
  out.target.resize(n);
  out.rendered.resize(n);
  out.height.resize(n);
  out.skin.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    out.target[i] = share(target.pressure[i], scale);
    out.rendered[i] = share(rendered[i], scale);
    out.height[i] = static_cast<std::int16_t>(
        std::lround(std::clamp(target.height[i] / kHeightScale, -kHighest, kHighest)));
    out.skin[i] = target.skin[i];
  }
}

ViewPoint fill_point(const TargetField& target, const Vec2& x, double pressure) {
  const auto p = floats(target.X_DP * Vec3(x.x(), x.y(), height_at(target, x)));
  return {static_cast<float>(x.x()),
          static_cast<float>(x.y()),
          static_cast<float>(pressure),
          p[0],
          p[1],
          p[2]};
}

void fill_paths(const PlanSnapshot& plan, ViewFrame& out) {
  out.path_count = 0;
  if (!plan.planned) return;
  out.paths.resize(std::max(out.paths.size(), plan.plan.paths.size() + plan.plan.foci.size()));
  for (const FocalPath& path : plan.plan.paths) {
    ViewPath& to = out.paths[out.path_count++];
    const TargetField& target = plan.target.patches[static_cast<std::size_t>(path.patch)];
    to.kind = 0;
    to.patch = static_cast<std::uint32_t>(path.patch);
    to.length = static_cast<float>(path.length);
    to.speed = static_cast<float>(path.speed);
    to.period = static_cast<float>(path.period);
    to.loop = static_cast<float>(plan.plan.loop);
    to.phase = 0.0F;
    to.points.clear();
    for (std::size_t i = 0; i < path.points.size(); ++i)
      to.points.push_back(fill_point(target, path.points[i], path.pressure[i]));
  }
  for (const FocalPoint& focus : plan.plan.foci) {
    ViewPath& to = out.paths[out.path_count++];
    const TargetField& target = plan.target.patches[static_cast<std::size_t>(focus.patch)];
    to.kind = 1;
    to.patch = static_cast<std::uint32_t>(focus.patch);
    to.length = to.speed = to.loop = 0.0F;
    to.phase = static_cast<float>(focus.phase);
    to.period =
        static_cast<float>(am_period(plan.settings->emit, plan.emission_rate) / plan.emission_rate);
    to.points.assign(1, fill_point(target, focus.position, focus.pressure));
  }
}

void fill_gate(const std::optional<GateResult>& gate, std::optional<ViewGate>& out) {
  out.reset();
  if (!gate) return;
  out.emplace();
  out->passed = gate->pass;
  out->share = static_cast<float>(gate->share);
  out->problem = name_of(gate->finding.problem);
  out->sentence = sentence(*gate);
  out->maxima = static_cast<std::uint32_t>(gate->shape.count());
  out->balance = static_cast<float>(gate->shape.balance);
  out->saddle = static_cast<float>(gate->shape.saddle);
  out->area = static_cast<float>(gate->shape.area);
  out->force = static_cast<float>(gate->shape.force);
}

void set(ViewFrame& frame, std::size_t number, double value) {
  frame.numbers[number] = static_cast<float>(value);
}

}  // namespace

// ---- recent values ----

void Recent::add(Clock::time_point now, double value) {
  entries_.push_back({now, value});
  trim(now);
}

void Recent::trim(Clock::time_point now) {
  while (!entries_.empty() &&
         std::chrono::duration<double>(now - entries_.front().at).count() > span_) {
    entries_.pop_front();
  }
}

double Recent::quantile(double p) {
  if (entries_.empty()) return kNone;
  sorted_.clear();
  for (const Entry& entry : entries_) sorted_.push_back(entry.value);
  const auto rank = static_cast<std::ptrdiff_t>(
      std::max(0.0, std::ceil(p * static_cast<double>(sorted_.size())) - 1.0));
  std::nth_element(sorted_.begin(), sorted_.begin() + rank, sorted_.end());
  return sorted_[static_cast<std::size_t>(rank)];
}

// ---- frames ----

void FrameMaker::refresh(ViewFrame& frame, ViewNews& news) {
  // first: once the run is seen as paused, the other snapshots are those of the pause
  snapshots_.refresh_run();
  new_step_ |= snapshots_.refresh_step();
  new_smoke_ |= snapshots_.refresh_volume();
  new_plan_ |= snapshots_.refresh_plan();
  if (!snapshots_.run().paused || snapshots_.plan().step == snapshots_.step().step)
    take(frame, news);
  fill_numbers(frame);
}

void FrameMaker::take(ViewFrame& frame, ViewNews& news) {
  if (std::exchange(new_step_, false)) {
    const StepSnapshot& step = snapshots_.step();
    frame.hand_count = 0;
    for (const Hand& hand : step.hands.hands) fill_hand(hand, frame.hands[frame.hand_count++]);
    frame.run.world_steps = static_cast<std::uint32_t>(step.step);
    frame.run.recording_time = step.recording_time;
  }
  if (std::exchange(new_smoke_, false)) {
    fill_smoke(snapshots_.volume(), frame.smoke);
    ++news.smoke;
  }
  if (std::exchange(new_plan_, false)) {
    take_plan(frame);
    frame.run.plan_updates = static_cast<std::uint32_t>(snapshots_.plan().id);
    ++news.fields;
  }
}

void FrameMaker::take_plan(ViewFrame& frame) {
  const PlanSnapshot& plan = snapshots_.plan();
  render(plan, rendered_);
  if (plan.planned) felt_.offer(plan, rendered_.patch);
  double scale = rendered_.max_target;
  for (const auto& field : rendered_.field)
    for (const double p : field) scale = std::max(scale, p);
  if (!(scale > 0.0)) scale = 1.0;
  const std::size_t count = plan.target.patches.size();
  frame.field_count = static_cast<std::uint32_t>(count);
  frame.fields.resize(std::max(frame.fields.size(), count));
  for (std::size_t i = 0; i < count; ++i)
    fill_field(plan.target.patches[i], rendered_.field[i], scale, frame.fields[i]);
  fill_paths(plan, frame);
  fill_gate(plan.gate, frame.gate);
}

void FrameMaker::fill_scores(ViewFrame& frame) const {
  const PlanSnapshot& plan = snapshots_.plan();
  const bool scored = plan.planned;
  Metrics metrics = rendered_.metrics;
  const PlanPercept percept = felt_.percept();
  metrics.felt_skill = percept.skill;
  metrics.sensation_level = percept.sensation_level;
  const auto all = quantities<Metrics>();
  const auto places = view_metric_places();
  for (std::size_t i = 0; i < all.size(); ++i)
    set(frame, places[i], scored ? value_of(all[i], metrics) : kNone);
  constexpr double kMm = 1e3;
  set(frame, kSigmaMm, scored ? kMm * rendered_.sigma : kNone);
  const Metrics& setting = rendered_.metrics_at_setting;
  set(frame, kSettingSigmaMm, scored ? kMm * plan.settings->sigma() : kNone);
  set(frame, kSettingRmse, scored ? setting.rmse : kNone);
  set(frame, kSettingCorrelation, scored ? setting.correlation : kNone);
}

std::uint32_t FrameMaker::flags(const ViewFrame& frame) const {
  const RunSnapshot& run = snapshots_.run();
  return (run.paused ? kViewPaused : 0U) | (run.page_hand_in_charge() ? kViewPageHand : 0U) |
         (frame.hand_count > 0 ? kViewHandInSight : 0U) | (run.fading ? kViewFading : 0U) |
         (mute_.on(MuteReason::Person) ? kViewMuted : 0U) |
         (mute_.on(MuteReason::Calibration) ? kViewCalibrating : 0U) |
         (mute_.on(MuteReason::Hot) ? kViewHot : 0U) | (run.device_lost ? kViewDeviceLost : 0U);
}

/// Without a hand there is no latency: the last value belongs to a hand that has left.
void FrameMaker::fill_latencies(ViewFrame& frame) {
  const auto now = Recent::Clock::now();
  double latency = 0.0;
  while (snapshots_.next_latency(latency)) latencies_.add(now, latency);
  latencies_.trim(now);
  const double unit = frame.hand_count > 0 ? kMs : kNone;
  set(frame, kLatencyMs, unit * snapshots_.plan().latency);
  set(frame, kLatencyP50Ms, unit * latencies_.quantile(0.5));
  set(frame, kLatencyP99Ms, unit * latencies_.quantile(0.99));
  set(frame, kLatencyMaxMs, unit * latencies_.quantile(1.0));
}

void FrameMaker::fill_numbers(ViewFrame& frame) {
  const StepSnapshot& step = snapshots_.step();
  const PlanSnapshot& plan = snapshots_.plan();
  const RunSnapshot& run = snapshots_.run();
  frame.run.time = run.time;
  frame.run.flags = flags(frame);
  frame.run.page_hand = run.page_hand;

  const double plan_time = plan.plan_time + plan.lift_time + plan.contact_time;
  set(frame, kTrackMs, kMs * step.track_time);
  set(frame, kHandMs, kMs * step.hand_time);
  set(frame, kWorldMs, kMs * step.world_time);
  set(frame, kContactMs, kMs * plan.contact_time);
  set(frame, kPlanMs, kMs * plan.plan_time);
  set(frame, kLiftMs, kMs * plan.lift_time);
  set(frame, kStepMs, kMs * (step.track_time + step.hand_time + step.world_time + plan_time));
  set(frame, kWorldHz, run.world_rate);
  set(frame, kPlanHz, run.plan_rate);

  fill_latencies(frame);
  set(frame, kBlocks, static_cast<double>(run.device.blocks));
  set(frame, kLateBlocks, static_cast<double>(run.device.late_blocks));
  set(frame, kMissedBlocks, static_cast<double>(run.device.missed_blocks));
  set(frame, kQueueBlocks, run.device.queue_blocks);
  fill_scores(frame);
  set(frame, kMaxTargetPa, rendered_.max_target);
  set(frame, kForceMn, kMn * rendered_.force);
  set(frame, kSmokeMn, kMn * rendered_.smoke_force);
  set(frame, kMovementMn, kMn * rendered_.movement_force);
  set(frame, kFullScalePa, run.full_scale_pressure);
  set(frame, kLapsCompleted,
      run.emit.laps_started > 0 ? 1.0 - static_cast<double>(run.emit.laps_cut) /
                                            static_cast<double>(run.emit.laps_started)
                                : kNone);
  set(frame, kTrackerAgeMs, frame.hand_count > 0 ? kMs * step.hands.age : kNone);
  set(frame, kIntensity, run.intensity);
  set(frame, kSaturated, static_cast<double>(run.emit.saturated));
}

}  // namespace prostm::viewer
