#include "prostm/pipeline/pipeline.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "prostm/core/settings.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/device/device_kinds.hpp"
#include "prostm/emit/compensation.hpp"
#include "prostm/pipeline/playable.hpp"

namespace prostm {
namespace {

const PipelineSettings& checked(const PipelineSettings& settings) {
  require_bounds(settings);
  if (!settings.X_DT.matrix().allFinite() || !settings.X_DT.linear().isUnitary(1e-6) ||
      settings.X_DT.linear().determinant() < 0.0) {
    throw std::invalid_argument("X_DT is not a pose; it must be a rotation and a finite position");
  }
  return settings;
}

/// Moves hands back in time, along their velocities [s].
void put_back(double time, HandFrame& frame) {
  if (time == 0.0) return;
  frame.time -= time;
  for (Hand& hand : frame.hands) {
    for (std::size_t j = 0; j < kJointCount; ++j) hand.position[j] -= time * hand.velocity[j];
  }
}

/// Whether the world stage is built from the same settings.
bool same_world(const PipelineSettings& a, const PipelineSettings& b) {
  return a.track == b.track && a.fluid == b.fluid && a.box == b.box && a.jets == b.jets &&
         a.fluid_pressure == b.fluid_pressure && a.contact == b.contact && a.world == b.world &&
         a.scene == b.scene;
}

/// Whether the plan stage is built from the same settings.
bool same_plans(const PipelineSettings& a, const PipelineSettings& b) {
  return a.plan == b.plan && a.am == b.am && a.emit == b.emit && a.world == b.world &&
         a.scene == b.scene && a.method == b.method && a.array_width == b.array_width &&
         a.safety == b.safety;
}

/// The device named by the settings, or the caller's own.
std::unique_ptr<Device> device_of(const PipelineSettings& settings, std::unique_ptr<Device> own) {
  if (own != nullptr) return as_stream(std::move(own));
  return make_device(settings.device, settings.device_setup());
}

/// The σ that a planner assumes for a target [m].
double sigma_on(const TargetField& target, const std::variant<Planner, AmPlanner>& planner) {
  if (const auto* of_foci = std::get_if<AmPlanner>(&planner)) return of_foci->settings().sigma;
  return std::get<Planner>(planner).settings().sigma_on(target);
}

/// Returns the settings after require_playable(). @throws as require_playable().
const PipelineSettings& playable(const PipelineSettings& settings, const DeviceInfo& device) {
  require_playable(settings, device);
  return settings;
}

/// Makes the planner of the method.
std::variant<Planner, AmPlanner> make_planner(const PipelineSettings& settings,
                                              std::size_t max_cells, double scene_full_scale,
                                              double emission_rate) {
  if (settings.method == Method::Am)
    return AmPlanner(am_settings(settings, emission_rate), max_cells);
  PlanSettings plan = plan_settings(settings, emission_rate);
  if (plan.full_scale_pressure == 0.0)
    plan.full_scale_pressure = emit_settings(settings, scene_full_scale).full_scale_pressure;
  return Planner(plan, max_cells);
}

}  // namespace

WorldStage::WorldStage(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
                       std::unique_ptr<World> world, std::span<const WorldKind> kinds)
    : hands_(std::move(hands)),
      filter_(checked(settings).track),
      X_DT_(settings.X_DT),
      pool_(settings.threads),
      world_(world ? std::move(world) : make_world(settings, pool_, kinds)),
      rasteriser_(world_->grid()),
      contact_(settings.contact, world_->grid()),
      steps_per_plan_(settings.steps_per_plan()),
      side_view_(settings.side_view) {
  if (world_->quantities().size() <= kMaxWorldQuantities) return;
  throw std::invalid_argument("a world declares " + std::to_string(world_->quantities().size()) +
                              " quantities; it must be at most " +
                              std::to_string(kMaxWorldQuantities));
}

void WorldStage::adopt(WorldStage& other) {
  hands_ = std::move(other.hands_);
  mute_ = other.mute_;
  X_DT_ = other.X_DT_;
  world_->continue_from(*other.world_);
}

void WorldStage::run(std::int64_t step, double time, double dt, WorldFrame& out) {
  prepare(dt);
  take(time, out);
  meet(step, time, dt, out);
  settle();
}

void WorldStage::prepare(double dt) {
  const StageTimer timer;
  world_->prepare(dt);
  const double time = timer.seconds();
  world_time_ += time;
  since_taken_ += time;
}

void WorldStage::take(double time, WorldFrame& out) {
  hands_->sample(time, out.hands);
  if (mute_) mute_->set(MuteReason::NoHand, out.hands.hands.empty());
  out.taken = time;
  out.arrival = time - out.hands.age;
  since_taken_ = 0.0;
}

void WorldStage::meet(std::int64_t step, double due, double dt, WorldFrame& out) {
  StageTimer timer;
  out.step = step;
  out.due = due;
  put_back(out.taken - due, out.hands);
  to_device(X_DT_, out.hands);
  filter_.apply(dt, out.hands);
  out.track_time = timer.lap();

  rasteriser_.move_to(world_->grid().p_DF);
  rasteriser_.rasterise(out.hands, pool_);
  out.hand_time = timer.lap();

  world_->meet(rasteriser_.raster());
  const double meeting = timer.lap();
  out.meet_time = since_taken_ + meeting;
  out.world_time = world_time_ + meeting;
  world_time_ = 0.0;

  out.targeted = targets(step);
  if (out.targeted) {
    const double since = dt * steps_per_plan_;
    const PressureSource& pressure = world_->pressure(since);
    out.contact_stats =
        contact_.extract(pressure, rasteriser_.raster(), out.hands, out.target, world_->parts());
    out.stimulus = world_->stimulus();
    world_->observe_target(out.hands, out.target, since);
  }
  out.contact_time = timer.lap();
  if (out.targeted && side_view_) view_from_side(out.side);
}

void WorldStage::settle() {
  const StageTimer timer;
  world_stats_ = world_->settle();
  world_time_ += timer.seconds();
}

void WorldStage::view_from_side(SideView& out) const {
  const GridShape& g = out.grid = world_->grid();
  const std::size_t size = static_cast<std::size_t>(g.nx) * static_cast<std::size_t>(g.nz);
  out.density.assign(size, 0.0F);
  out.hand.assign(size, 0);
  const auto width = static_cast<std::size_t>(g.nx);
  for (int k = 0; k < g.nz; ++k) {
    const std::size_t first = static_cast<std::size_t>(k) * width;
    for (int j = 0; j < g.ny; ++j) {
      const SeenRow row = world_->seen_row(j, k);
      for (std::size_t i = 0; i < row.density.size(); ++i)
        out.density[first + i] = std::max(out.density[first + i], row.density[i]);
      for (std::size_t i = 0; i < row.open.size(); ++i)
        if (row.open[i] == 0) out.hand[first + i] = 1;
    }
  }
}

PlanStage::PlanStage(const PipelineSettings& settings, std::size_t max_cells, double full_scale,
                     const DeviceInfo& device, std::shared_ptr<const SafetyLevels> levels)
    : planner_(
          make_planner(playable(settings, device), max_cells, full_scale, device.emission_rate())),
      emit_settings_(emit_settings(settings, full_scale)),
      emission_rate_(device.emission_rate()),
      max_speed_(device.max_focus_speed()),
      gate_(static_cast<int>(std::lround(settings.world_rate / settings.steps_per_plan())),
            max_cells),
      emitter_(make_emitter(settings.method, emit_settings_, emission_rate_, max_speed_)),
      samples_(make_sample_chain(*emitter_, device,
                                 {.power = emit_settings_.power_limit,
                                  .caps = settings.safety,
                                  .levels = levels ? std::move(levels) : levels_of(settings)})) {}

void PlanStage::obey(const std::shared_ptr<Mute>& mute) {
  emitter_->obey(mute);
  samples_->obey(mute);
}

void PlanStage::run(const WorldFrame& contact, PlanFrame& out) {
  StageTimer timer;
  out.id = ++updates_;
  out.start = contact.taken;
  out.max_skin_length = 0.0;
  out.played = {};
  out.full_scale_pressure = full_scale_pressure();
  out.emission_rate = emission_rate_;
  out.status = std::visit(
      [&](auto& planner) { return planner.plan(contact.target, out.plan, out.stats); }, planner_);
  out.plan_time = timer.lap();
  if (out.status != PlanStatus::Planned) {
    emitter_->lose();
  } else {
    for (std::size_t i = 0; i < contact.target.patches.size(); ++i)
      out.sigma[i] = sigma_on(contact.target.patches[i], planner_);
    LiftedPlan& lifted = emitter_->draft();
    lift(out.plan, contact.target, lifted);
    compensate_tilt(lifted, contact.target, emit_settings_.tilt_bound);
    lifted.id = out.id;
    for (const LiftedPath& path : lifted.paths)
      out.max_skin_length = std::max(out.max_skin_length, path.length);
    out.played = played_plan(lifted, emission_rate_, max_speed_);
    take_played(out.played, out.plan);
    emitter_->submit();
  }
  out.lift_time = timer.lap();
  // computed after the plan was submitted, to save latency
  out.gate.reset();
  if (contact.stimulus) out.gate = gate_.judge(contact.hands, contact.target, *contact.stimulus);
}

void play_until(Device& device, double time) {
  const auto due = static_cast<std::int64_t>(std::llround(time * device.info().sample_rate));
  const std::int64_t blocks = (due - device.samples()) / device.info().block_samples;
  if (blocks > 0) device.pull(static_cast<int>(blocks));
}

Pipeline::Pipeline(const PipelineSettings& settings, std::unique_ptr<HandSource> hands,
                   std::shared_ptr<Mute> mute, std::unique_ptr<Device> device,
                   std::unique_ptr<World> world, std::span<const WorldKind> kinds)
    : settings_(settings),
      mute_(std::move(mute)),
      own_world_(world != nullptr),
      kinds_(kinds),
      levels_(levels_of(settings)),
      world_stage_(
          std::make_unique<WorldStage>(settings, std::move(hands), std::move(world), kinds)),
      device_(device_of(settings, std::move(device))),
      sound_(mute_, device_->info().sample_rate),
      plans_(std::make_unique<PlanStage>(settings, world_stage_->max_cells(),
                                         world_stage_->world().full_scale_pressure(),
                                         device_->info(), levels_)) {
  if (device_->info().keeps_time) world_stage_->tell(mute_);
  plans_->obey(mute_);
  plans_->show(sound_);
  if (device_->start(plans_->samples()) != DeviceStatus::Running)
    throw std::invalid_argument(device_->problem());
}

Pipeline::~Pipeline() {
  device_->stop();
}

void Pipeline::reconfigure(const PipelineSettings& settings) {
  std::unique_ptr<WorldStage> stage;
  if (!own_world_ && !same_world(settings, settings_))
    stage = std::make_unique<WorldStage>(settings, nullptr, nullptr, kinds_);
  const WorldStage& next = stage ? *stage : *world_stage_;
  std::unique_ptr<PlanStage> plans;
  std::shared_ptr<const SafetyLevels> levels = levels_;
  if (!same_plans(settings, settings_) || next.max_cells() != world_stage_->max_cells()) {
    if (settings.safety.head_distance != settings_.safety.head_distance)
      levels = levels_of(settings);
    plans = std::make_unique<PlanStage>(
        settings, next.max_cells(), next.world().full_scale_pressure(), device_->info(), levels);
    plans->continue_from(*plans_);
    plans->obey(mute_);
    plans->show(sound_);
    const std::string problem = restart(*plans);
    if (!problem.empty()) throw std::invalid_argument(problem);
  }
  // nothing fails from here on
  if (stage) {
    stage->adopt(*world_stage_);
    world_stage_ = std::move(stage);
  }
  if (plans) plans_ = std::move(plans);
  levels_ = std::move(levels);
  world_stage_->set_steps_per_plan(settings.steps_per_plan());
  settings_ = settings;
}

std::string Pipeline::restart(PlanStage& plans) {
  silence();
  device_before_ = device_stats();
  if (device_->start(plans.samples()) == DeviceStatus::Running) {
    merge(plans_->emitter().stats(), emit_before_);
    merge(plans_->samples().safety(), safety_before_);
    return {};
  }
  std::string problem = device_->problem();
  device_->start(plans_->samples());
  return problem;
}

void Pipeline::silence() {
  fade_out();
  // play times of samples are available only until the device stops
  constexpr double kLongest = 0.1;  // [s]
  const double end = steady_now() + kLongest;
  while (!sound_.is_read() && steady_now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  device_->stop();
  sound_.end();
}

/// Waits until a block after the fade has been played, however late the device's thread is.
void Pipeline::fade_out() {
  constexpr double kLongest = 1.0;  // [s], in case the device has stopped playing
  const DeviceInfo& device = device_->info();
  if (!device.keeps_time) return;
  plans_->emitter().lose();
  const double fade = std::max(settings_.method == Method::Am ? 1.0 / settings_.emit.am_frequency
                                                              : settings_.emit.stall_fade_time,
                               SoundWatch::kMuteTime);
  // the block being filled may not contain the fade yet
  const std::int64_t silent =
      device_->stats().blocks + 2 +
      std::llround(std::ceil(fade * device.sample_rate)) / device.block_samples;
  const double end = steady_now() + kLongest;
  const auto waiting = [&] {
    return device_->status() == DeviceStatus::Running && steady_now() < end &&
           (device_->stats().blocks <= silent ||
            device_->samples() <= silent * device.block_samples);
  };
  while (waiting()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

DeviceStats Pipeline::device_stats() const {
  DeviceStats sum = device_before_;
  merge(device_->stats(), sum);
  return sum;
}

EmitStats Pipeline::emit_stats() const {
  EmitStats sum = emit_before_;
  merge(plans_->emitter().stats(), sum);
  return sum;
}

SafetyStats Pipeline::safety_stats() const {
  SafetyStats sum = safety_before_;
  merge(plans_->samples().safety(), sum);
  return sum;
}

void Pipeline::watch_heat(double time) {
  constexpr double kCooling = 1.0;  // keeps a flickering flag on [s]
  if (device_->is_hot()) cool_at_ = time + kCooling;
  mute_->set(MuteReason::Hot, time < cool_at_);
}

bool Pipeline::step(double dt) {
  ++steps_;
  time_ += dt;
  watch_heat(time_);
  // earlier plans play up to the time of these hands
  play_until(*device_, time_);
  world_stage_->run(steps_, time_, dt, contact_frame_);
  if (contact_frame_.targeted) plans_->run(contact_frame_, plan_frame_);
  return contact_frame_.targeted;
}

}  // namespace prostm
