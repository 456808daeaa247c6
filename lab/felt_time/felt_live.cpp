#include "felt_time/felt_live.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/acoustics/field/loop_field.hpp"
#include "prostm/acoustics/skin/skin_percept.hpp"
#include "prostm/emit/compensation.hpp"
#include "prostm/score/physical.hpp"
#include "prostm/score/plan_percept.hpp"
#include "prostm/score/running_drives.hpp"

namespace prostm::bench {
namespace {

constexpr double kBlock = 1e-3;  // block that a device requests at a time [s]

void check(std::span<const LivePlan> plans, const LiveSettings& settings, const TimeSkin& skin) {
  if (plans.empty()) throw std::invalid_argument("there must be at least one plan");
  const SkinPatch& patch = skin.patch();
  const TargetField& first = plans.front().target;
  for (const LivePlan& live : plans) {
    const TargetField& target = live.target;
    if (target.rows != patch.rows || target.cols != patch.cols || target.cell != patch.cell ||
        target.origin != first.origin || target.skin != first.skin) {
      throw std::invalid_argument("all targets must be on one raster, that of the skin's patch");
    }
  }
  const double per_tick = settings.sample_rate * kFeltTick;
  if (per_tick < 1.0 || per_tick != std::round(per_tick)) {
    throw std::invalid_argument("the sample rate must be a multiple of 5 kHz");
  }
  const double judged = static_cast<double>(plans.size()) * settings.interval - settings.settling;
  if (!(judged >= kFeltWindow)) {
    throw std::invalid_argument("the plans must last for 40 ms after they have settled");
  }
}

/// Fills in the full scales that are not given.
LiveSettings completed(std::span<const LivePlan> plans, LiveSettings settings,
                       const TransducerArray& array) {
  double largest = 0.0;
  for (const LivePlan& live : plans) largest = std::max(largest, largest_pressure(live.plan));
  if (!(largest > 0.0)) throw std::invalid_argument("the plans have no pressure anywhere");
  if (settings.emit.full_scale_pressure <= 0.0) settings.emit.full_scale_pressure = largest;
  if (settings.drives.full_scale_pa > 0.0) return settings;
  constexpr std::size_t kLookedAt = 5;
  const Medium air;
  double least = 0.0;
  for (std::size_t i = 0; i < std::min(kLookedAt, plans.size()); ++i) {
    const LivePlan& live = plans[i * plans.size() / std::min(kLookedAt, plans.size())];
    if (!(largest_pressure(live.plan) > 0.0)) continue;
    TargetFrame frame;
    frame.patches.push_back(live.target);
    const LoopSamples loop = plan_loop(live.plan, frame, settings.emit, settings.sample_rate);
    LoopDriveResult drives;
    loop_drives(
        array, air, loop, settings.drives, [](int, int) { return true; }, drives);
    least = least > 0.0 ? std::min(least, drives.full_scale_pa) : drives.full_scale_pa;
  }
  settings.drives.full_scale_pa = least;
  return settings;
}

/// Plays the plans, one stretch of pressure for each.
class Playing {
 public:
  Playing(Method method, const LiveSettings& settings, const TransducerArray& array,
          const TargetField& raster, WorkerPool& pool)
      : settings_(settings),
        emitter_(make_emitter(method, settings.emit, settings.sample_rate)),
        drives_(array, air_, settings.drives, emitter_->foci(), settings.sample_rate),
        packed_(array, air_),
        raster_(raster),
        skin_(skin_surface(raster)),
        pool_(pool),
        block_(static_cast<std::size_t>(std::llround(kBlock * settings.sample_rate))),
        blocks_(static_cast<std::size_t>(std::llround(settings.interval / kBlock))) {}

  /// Appends the pressure on the raster until the next plan comes, tick by tick.
  void play(const LivePlan& live, std::int64_t id, std::vector<float>& pressure) {
    TargetFrame frame;
    frame.patches.push_back(live.target);
    LiftedPlan& draft = emitter_->draft();
    lift(live.plan, frame, draft);
    compensate_tilt(draft, frame, settings_.emit.tilt_bound);
    draft.id = id;
    emitter_->submit();
    const auto foci = static_cast<std::size_t>(emitter_->foci());
    std::vector<FocusSample> samples(blocks_ * block_ * foci);
    for (std::size_t b = 0; b < blocks_; ++b) {
      emitter_->fill(next_, std::span(samples).subspan(b * block_ * foci, block_ * foci));
      next_ += static_cast<std::int64_t>(block_);
    }
    drives_.next(samples, outputs_);
    const auto ticks = static_cast<int>(std::llround(settings_.interval / kFeltTick));
    const std::size_t before = pressure.size(), parts = static_cast<std::size_t>(ticks);
    pressure.resize(before + parts * raster_.size(), 0.0F);
    if (outputs_.isZero(0.0F)) return;
    const LoopPressure field = loop_pressure(packed_, air_, LoopBasis(packed_, outputs_, pool_),
                                             skin_.points, ticks, pool_);
    for (std::size_t m = 0; m < skin_.cell.size(); ++m) {
      for (std::size_t k = 0; k < parts; ++k) {
        pressure[before + k * raster_.size() + skin_.cell[m]] = field.frame[m * parts + k];
      }
    }
  }

  EmitStats stats() const { return emitter_->stats(); }
  std::int64_t short_samples() const { return drives_.short_samples(); }

 private:
  const Medium air_;
  LiveSettings settings_;
  std::unique_ptr<Emitter> emitter_;
  RunningDrives drives_;
  PackedArray packed_;
  const TargetField& raster_;
  SkinSurface skin_;
  WorkerPool& pool_;
  std::size_t block_, blocks_;  // samples, and blocks of them between plans
  std::int64_t next_ = 0;
  LoopDrives outputs_;
};

void clear_off_skin(const TargetField& raster, std::vector<double>& map) {
  for (std::size_t c = 0; c < map.size(); ++c) {
    if (raster.skin[c] == 0) map[c] = 0.0;
  }
}

void judge(std::span<const LivePlan> plans, const LiveSettings& settings,
           const std::vector<float>& felt, LiveFelt& out) {
  const TargetField& raster = plans.front().target;
  const std::size_t cells = raster.size(), all = felt.size() / cells;
  const auto first = static_cast<std::size_t>(std::llround(settings.settling / kFeltTick));
  const auto window = static_cast<std::size_t>(std::llround(kFeltWindow / kFeltTick));
  const double per_tick = kFeltTick / settings.interval;
  out.percept = percept_over(felt, cells, first, all - first);
  for (const double root : out.percept) {
    out.intensity += root * root * raster.cell * raster.cell / kPerceptArea;
  }
  out.intensity = std::sqrt(out.intensity);
  clear_off_skin(raster, out.percept);
  out.mean_target.assign(cells, 0.0);
  const auto first_plan = static_cast<std::size_t>(static_cast<double>(first) * per_tick);
  for (std::size_t i = first_plan; i < plans.size(); ++i) {
    for (std::size_t c = 0; c < cells; ++c) {
      out.mean_target[c] +=
          plans[i].target.pressure[c] / static_cast<double>(plans.size() - first_plan);
    }
  }
  TargetField mean = raster;
  mean.pressure = out.mean_target;
  if (!(max_pressure(mean) > 0.0)) throw std::invalid_argument("the targets have no pressure");
  out.metrics = score_physical(mean, out.percept, 0.0);
  for (std::size_t tick = first; tick + window <= all; tick += window) {
    std::vector<double> percept = percept_over(felt, cells, tick, window);
    clear_off_skin(raster, percept);
    const double middle =
        (static_cast<double>(tick) + 0.5 * static_cast<double>(window)) * per_tick;
    const auto plan = std::min(plans.size() - 1, static_cast<std::size_t>(middle));
    out.window_skill_8.push_back(score_physical(plans[plan].target, percept, 0.0).skill_8);
    out.window_percept.insert(out.window_percept.end(), percept.begin(), percept.end());
  }
}

}  // namespace

bool felt_live(Method method, std::span<const LivePlan> plans, const LiveSettings& settings,
               const TransducerArray& array, const TimeSkin& skin, WorkerPool& pool,
               const std::function<bool(std::size_t done, std::size_t all)>& progress,
               LiveFelt& out) {
  check(plans, settings, skin);
  out = LiveFelt();
  const LiveSettings all = completed(plans, settings, array);
  Playing playing(method, all, array, plans.front().target, pool);
  std::vector<float> pressure;
  for (std::size_t i = 0; i < plans.size(); ++i) {
    if (!progress(i, plans.size())) return false;
    playing.play(plans[i], static_cast<std::int64_t>(i) + 1, pressure);
  }
  judge(plans, all, skin.respond(pressure), out);
  out.emit = playing.stats();
  out.short_samples = playing.short_samples();
  return true;
}

}  // namespace prostm::bench
