#include "pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "core/require.hpp"
#include "core/stage_timer.hpp"
#include "emit/compensation.hpp"

namespace prostm {
namespace {

const PipelineSettings& checked(const PipelineSettings& settings) {
  require_between("fluid_rate", settings.fluid_rate, 10.0, 1000.0, "Hz");
  require_between("fluid_steps_per_plan", settings.fluid_steps_per_plan, 0, 100);
  require_between("frame_wait", settings.frame_wait, 0.0, 0.1, "s");
  if (!settings.X_DT.matrix().allFinite() || !settings.X_DT.linear().isUnitary(1e-6) ||
      settings.X_DT.linear().determinant() < 0.0) {
    throw std::invalid_argument(
        "X_DT is no pose; it must be a rotation and a place that is finite");
  }
  return settings;
}

/// Hands as they were so long before [s].
void put_back(double time, HandFrame& frame) {
  if (time == 0.0) return;
  frame.time -= time;
  for (Hand& hand : frame.hands) {
    for (std::size_t j = 0; j < kJointCount; ++j) hand.position[j] -= time * hand.velocity[j];
  }
}

/// γ belongs to full scale: a target at the scene's full-scale pressure is rendered γ times as
/// strong.
/// Settings as a text, to see whether they differ.
class SettingsText final : public SettingsVisitor {
 public:
  void field(const char* name, double& value) override { put(name, value); }
  void field(const char* name, int& value) override { put(name, value); }
  void field(const char* name, bool& value) override { put(name, value); }
  void field(const char* name, std::string& value) override { put(name, value); }
  std::string text() const { return text_.str(); }

 private:
  template <class T>
  void put(const char* name, const T& value) {
    text_ << name << '=' << value << '\n';
  }
  std::ostringstream text_;
};

/// What the smoke's stage is built from.
std::string smoke_text(PipelineSettings s) {
  SettingsText text;
  s.track.visit(text);
  s.fluid.visit(text);
  s.contact.visit(text);
  return text.text() + s.scene;
}

/// What the planner's stage is built from.
std::string plan_text(PipelineSettings s) {
  SettingsText text;
  s.plan.visit(text);
  s.am.visit(text);
  s.emit.visit(text);
  return text.text() + s.scene + s.method + (s.array_width ? "widths" : "");
}

void add(const EmitStats& more, EmitStats& sum) {
  sum.samples += more.samples;
  sum.saturated += more.saturated;
  sum.limited += more.limited;
  sum.faded += more.faded;
  sum.laps_started += more.laps_started;
  sum.laps_cut += more.laps_cut;
  sum.stalls += more.stalls;
  sum.refused_plans += more.refused_plans;
  sum.dropped_paths += more.dropped_paths;
  sum.max_focus_step = std::max(sum.max_focus_step, more.max_focus_step);
}

/// The planner of the method.
std::variant<Planner, AmPlanner> make_planner(const PipelineSettings& settings,
                                              std::size_t max_cells, double scene_full_scale) {
  if (method_from_name(settings.method) == Method::Am) return AmPlanner(settings.am, max_cells);
  PlanSettings plan = plan_settings(settings);
  if (plan.full_scale_pressure == 0.0)
    plan.full_scale_pressure = emit_settings(settings, scene_full_scale).full_scale_pressure;
  return Planner(plan, max_cells);
}

}  // namespace

SmokeStage::SmokeStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands)
    : hands_(std::move(hands)),
      filter_(checked(settings).track),
      X_DT_(settings.X_DT),
      scene_(scene_from_name(settings.scene)),
      pool_(settings.threads),
      fluid_(settings.fluid, scene_, pool_),
      rasteriser_(fluid_.grid()),
      contact_(settings.contact, fluid_.grid()),
      steps_per_plan_(settings.steps_per_plan()),
      side_view_(settings.side_view) {}

void SmokeStage::adopt(SmokeStage& other) {
  hands_ = std::move(other.hands_);
  mute_ = other.mute_;
  X_DT_ = other.X_DT_;
  if (fluid_.grid() == other.fluid_.grid()) fluid_.copy_state(other.fluid_);
}

void SmokeStage::run(std::int64_t step, double time, double dt, ContactFrame& out) {
  prepare(dt);
  take(time, out);
  meet(step, time, dt, out);
  settle();
}

void SmokeStage::prepare(double dt) {
  const StageTimer timer;
  fluid_.prepare(dt);
  const double time = timer.seconds();
  fluid_time_ += time;
  since_taken_ += time;
}

void SmokeStage::take(double time, ContactFrame& out) {
  hands_->sample(time, out.hands);
  if (mute_) mute_->set(MuteReason::NoHand, out.hands.hands.empty());
  out.taken = time;
  out.arrival = time - out.hands.age;
  since_taken_ = 0.0;
}

void SmokeStage::meet(std::int64_t step, double due, double dt, ContactFrame& out) {
  StageTimer timer;
  out.step = step;
  out.due = due;
  put_back(out.taken - due, out.hands);
  to_device(X_DT_, out.hands);
  filter_.apply(dt, out.hands);
  out.track_time = timer.lap();

  rasteriser_.rasterise(out.hands, pool_);
  out.hand_time = timer.lap();

  fluid_.meet(rasteriser_.raster());
  const double meeting = timer.lap();
  out.meet_time = since_taken_ + meeting;
  out.fluid_time = fluid_time_ + meeting;
  fluid_time_ = 0.0;

  out.targeted = targets(step);
  if (out.targeted) {
    const double since_last = dt * steps_per_plan_;
    out.contact = contact_.extract(fluid_, rasteriser_.raster(), out.hands, since_last, out.target);
  }
  out.contact_time = timer.lap();
  if (out.targeted && side_view_) view_from_side(out.side);
}

void SmokeStage::settle() {
  const StageTimer timer;
  fluid_stats_ = fluid_.settle();
  fluid_time_ += timer.seconds();
}

void SmokeStage::view_from_side(SideView& out) const {
  const GridShape& g = fluid_.grid();
  const auto smoke = fluid_.smoke();
  const auto free = fluid_.fluid_cells();
  const std::size_t size = static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.nz);
  out.smoke.assign(size, 0.0F);
  out.hand.assign(size, 0);
  for (int k = 0; k < g.nz; ++k) {
    for (int j = 0; j < g.ny; ++j) {
      for (int i = 0; i < g.nx; ++i) {
        const std::size_t c = g.cell_index(i, j, k),
                          pixel = g.cell_index(i, 0, 0) + static_cast<std::size_t>(k * g.nx);
        out.smoke[pixel] = std::max(out.smoke[pixel], smoke[c]);
        if (free[c] == 0) out.hand[pixel] = 1;
      }
    }
  }
}

PlanStage::PlanStage(const PipelineSettings& settings, std::size_t max_cells, double full_scale)
    : planner_(make_planner(settings, max_cells, full_scale)),
      emit_settings_(emit_settings(settings, full_scale)),
      emitter_(make_emitter(method_from_name(settings.method), emit_settings_,
                            settings.simulated_array.sample_rate)) {}

void PlanStage::run(const ContactFrame& contact, PlanFrame& out) {
  StageTimer timer;
  out.id = ++updates_;
  out.start = contact.taken;
  out.max_skin_length = 0.0;
  out.full_scale_pressure = full_scale_pressure();
  out.status = std::visit(
      [&](auto& planner) { return planner.plan(contact.target, out.plan, out.stats); }, planner_);
  out.plan_time = timer.lap();
  if (out.status != PlanStatus::Planned) {
    emitter_->lose();
  } else {
    LiftedPlan& lifted = emitter_->draft();
    lift(out.plan, contact.target, lifted);
    compensate_tilt(lifted, contact.target, emit_settings_.tilt_bound);
    lifted.id = out.id;
    lifted.hand_time = contact.arrival;
    for (const LiftedPath& path : lifted.paths)
      out.max_skin_length = std::max(out.max_skin_length, path.length);
    emitter_->submit();
  }
  out.lift_time = timer.lap();
}

void play_until(SimulatedArray& device, double time) {
  const auto due = static_cast<std::int64_t>(std::llround(time * device.info().sample_rate));
  const std::int64_t blocks = (due - device.samples()) / device.info().block_samples;
  if (blocks > 0) device.pull(static_cast<int>(blocks));
}

Pipeline::Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
                   std::shared_ptr<Mute> mute)
    : settings_(settings),
      mute_(std::move(mute)),
      smoke_(std::make_unique<SmokeStage>(settings, std::move(hands))),
      plans_(std::make_unique<PlanStage>(settings, smoke_->max_cells(),
                                         smoke_->scene().full_scale_pressure)),
      device_(settings.simulated_array, settings.transducers, Medium{}) {
  if (settings.simulated_array.realtime) smoke_->tell(mute_);
  plans_->emitter().obey(mute_);
  if (device_.start(plans_->emitter()) != DeviceStatus::Running)
    throw std::invalid_argument(device_.problem());
}

void Pipeline::reconfigure(const PipelineSettings& settings) {
  std::unique_ptr<SmokeStage> smoke;
  if (smoke_text(settings) != smoke_text(settings_))
    smoke = std::make_unique<SmokeStage>(settings, nullptr);
  const SmokeStage& next = smoke ? *smoke : *smoke_;
  std::unique_ptr<PlanStage> plans;
  if (plan_text(settings) != plan_text(settings_) || next.max_cells() != smoke_->max_cells()) {
    plans =
        std::make_unique<PlanStage>(settings, next.max_cells(), next.scene().full_scale_pressure);
    plans->continue_from(*plans_);
    plans->emitter().obey(mute_);
    const std::string problem = restart(plans->emitter());
    if (!problem.empty()) throw std::invalid_argument(problem);
  }
  // nothing fails from here on
  if (smoke) {
    smoke->adopt(*smoke_);
    smoke_ = std::move(smoke);
  }
  if (plans) plans_ = std::move(plans);
  smoke_->set_steps_per_plan(settings.steps_per_plan());
  settings_ = settings;
}

std::string Pipeline::restart(Emitter& emitter) {
  silence();
  device_before_ = device_stats();
  if (device_.start(emitter) == DeviceStatus::Running) {
    add(plans_->emitter().stats(), emit_before_);
    return {};
  }
  std::string problem = device_.problem();
  device_.start(plans_->emitter());
  return problem;
}

void Pipeline::silence() {
  fade_out();
  device_.stop();
}

/// Until a block that follows the fade is played, however late the device's thread is.
void Pipeline::fade_out() {
  constexpr double kLongest = 1.0;  // [s], for a device that plays nothing any more
  const SimulatedArraySettings& device = settings_.simulated_array;
  if (!device.realtime) return;
  plans_->emitter().lose();
  const double fade = method_from_name(settings_.method) == Method::Am
                          ? 1.0 / settings_.emit.am_frequency
                          : settings_.emit.stall_fade_time;
  // the block that is being filled has not heard of it
  const std::int64_t silent =
      device_.stats().blocks + 2 +
      std::llround(std::ceil(fade * device.sample_rate)) / device.block_samples;
  const double end = steady_now() + kLongest;
  const auto waiting = [&] {
    return device_.status() == DeviceStatus::Running && steady_now() < end &&
           (device_.stats().blocks <= silent || device_.samples() <= silent * device.block_samples);
  };
  while (waiting()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

DeviceStats Pipeline::device_stats() const {
  DeviceStats sum = device_.stats();
  sum.blocks += device_before_.blocks;
  sum.late_blocks += device_before_.late_blocks;
  sum.missed_blocks += device_before_.missed_blocks;
  return sum;
}

EmitStats Pipeline::emit_stats() const {
  EmitStats sum = emit_before_;
  add(plans_->emitter().stats(), sum);
  return sum;
}

bool Pipeline::step(double dt) {
  ++steps_;
  time_ += dt;
  // what was planned before plays up to the moment that these hands were seen
  play_until(device_, time_);
  smoke_->run(steps_, time_, dt, contact_frame_);
  if (contact_frame_.targeted) plans_->run(contact_frame_, plan_frame_);
  return contact_frame_.targeted;
}

}  // namespace prostm
