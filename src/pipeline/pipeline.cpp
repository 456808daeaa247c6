#include "pipeline/pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/require.hpp"
#include "core/stage_timer.hpp"
#include "emit/compensation.hpp"

namespace prostm {
namespace {

Pose tracker_pose(const std::string& name) {
  if (name == "centre") return default_tracker_pose();
  if (name == "ultraleap-kit") return ultraleap_kit_pose();
  throw std::invalid_argument("unknown tracker pose \"" + name +
                              "\"; known are centre and ultraleap-kit");
}

const PipelineSettings& checked(const PipelineSettings& settings) {
  require_between("fluid_rate", settings.fluid_rate, 10.0, 1000.0, "Hz");
  require_between("fluid_steps_per_plan", settings.fluid_steps_per_plan, 0, 100);
  return settings;
}

/// γ belongs to full scale: a target at the scene's full-scale pressure is rendered γ times as
/// strong.
EmitSettings with_full_scale(const PipelineSettings& settings, double scene_full_scale) {
  EmitSettings emit = settings.emit;
  if (emit.full_scale_pressure == 0.0)
    emit.full_scale_pressure = settings.plan.gain * scene_full_scale;
  return emit;
}

/// The planner of the method.
std::variant<Planner, AmPlanner> make_planner(const PipelineSettings& settings,
                                              std::size_t max_cells) {
  if (method_from_name(settings.method) == Method::Am) return AmPlanner(settings.am, max_cells);
  return Planner(plan_settings(settings), max_cells);
}

}  // namespace

SmokeStage::SmokeStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands)
    : hands_(std::move(hands)),
      filter_(checked(settings).track),
      X_DT_(tracker_pose(settings.tracker)),
      scene_(scene_from_name(settings.scene)),
      pool_(settings.threads),
      fluid_(settings.fluid, scene_, pool_),
      rasteriser_(fluid_.grid()),
      contact_(settings.contact, fluid_.grid()),
      steps_per_plan_(settings.steps_per_plan()),
      side_view_(settings.side_view) {}

void SmokeStage::run(std::int64_t step, double time, double dt, ContactFrame& out) {
  StageTimer timer;
  out.step = step;
  out.arrival = time;
  hands_->sample(time, out.hands);
  to_device(X_DT_, out.hands);
  filter_.apply(dt, out.hands);
  out.track_time = timer.lap();

  rasteriser_.rasterise(out.hands, pool_);
  out.hand_time = timer.lap();

  out.fluid = fluid_.step(dt, rasteriser_.raster());
  out.fluid_time = timer.lap();

  out.targeted = step % steps_per_plan_ == 0;
  if (out.targeted) {
    const double since_last = dt * steps_per_plan_;
    out.contact = contact_.extract(fluid_, rasteriser_.raster(), out.hands, since_last, out.target);
  }
  out.contact_time = timer.lap();
  if (out.targeted && side_view_) view_from_side(out.side);
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
    : planner_(make_planner(settings, max_cells)),
      emit_settings_(with_full_scale(settings, full_scale)),
      emitter_(make_emitter(method_from_name(settings.method), emit_settings_,
                            settings.simulated_array.sample_rate)) {}

void PlanStage::run(const ContactFrame& contact, PlanFrame& out) noexcept {
  out.id = ++updates_;
  out.max_skin_length = 0.0;
  out.status = std::visit(
      [&](auto& planner) { return planner.plan(contact.target, out.plan, out.stats); }, planner_);
  StageTimer timer;
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
  out.lift_time = timer.seconds();
}

void play_until(SimulatedArray& device, double time) {
  const auto due = static_cast<std::int64_t>(std::llround(time * device.info().sample_rate));
  const std::int64_t blocks = (due - device.samples()) / device.info().block_samples;
  if (blocks > 0) device.pull(static_cast<int>(blocks));
}

Pipeline::Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands)
    : smoke_(settings, std::move(hands)),
      plans_(settings, smoke_.max_cells(), smoke_.scene().full_scale_pressure),
      device_(settings.simulated_array, settings.transducers, Medium{}) {
  if (device_.start(plans_.emitter()) != DeviceStatus::Running)
    throw std::invalid_argument(device_.problem());
}

bool Pipeline::step(double dt) {
  ++steps_;
  time_ += dt;
  // what was planned before plays up to the moment that these hands were seen
  play_until(device_, time_);
  smoke_.run(steps_, time_, dt, contact_frame_);
  if (contact_frame_.targeted) plans_.run(contact_frame_, plan_frame_);
  return contact_frame_.targeted;
}

}  // namespace prostm
