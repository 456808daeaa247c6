#include "prostm/pipeline/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "prostm/emit/played.hpp"
#include "prostm/plan/quasi_static.hpp"

namespace prostm {
namespace {

/// σ that a patch was planned with [m].
double sigma_of(const PipelineSettings& settings, const TargetField& target) {
  const bool by_place = settings.array_width && settings.method != Method::Am;
  return by_place ? settings.plan.sigma_on(target) : settings.sigma();
}

/// Means over blocks of B³ cells, of n³ blocks. Smoke is never negative: advection weighs it with
/// weights from 0 to 1.
template <std::size_t B>
void average(std::span<const float> smoke, std::size_t n, std::span<std::uint8_t> out) {
  constexpr float kScale = 255.0F / static_cast<float>(B * B * B);
  const std::size_t width = n * B;
  std::array<float, B * kSmokeViewCells> row;  // sums over the rows that a row of blocks takes
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < n; ++j) {
      row.fill(0.0F);
      for (std::size_t z = k * B; z < (k + 1) * B; ++z) {
        for (std::size_t y = j * B; y < (j + 1) * B; ++y) {
          const float* cells = smoke.data() + (z * width + y) * width;
          for (std::size_t x = 0; x < width; ++x) row[x] += cells[x];
        }
      }
      std::uint8_t* to = out.data() + (k * n + j) * n;
      for (std::size_t i = 0; i < n; ++i) {
        float sum = 0.0F;
        for (std::size_t x = 0; x < B; ++x) sum += row[i * B + x];
        // via int: float to int is one instruction, float to uint8 has none
        to[i] = static_cast<std::uint8_t>(static_cast<int>(std::min(sum * kScale + 0.5F, 255.0F)));
      }
    }
  }
}

}  // namespace

void view_smoke(const Fluid& fluid, SmokeView& out) {
  const GridShape& grid = fluid.grid();
  // whole blocks: the cells along an edge are a multiple of 16, and at most 160
  int block = 1;
  while (grid.nx / block > kSmokeViewCells || grid.nx % block != 0) ++block;
  out.n = grid.nx / block;
  out.p_DF = grid.p_DF;
  out.edge = grid.cell * grid.nx;
  const auto n = static_cast<std::size_t>(out.n);
  out.density.resize(n * n * n);
  switch (block) {
    case 1:
      return average<1>(fluid.smoke(), n, out.density);
    case 2:
      return average<2>(fluid.smoke(), n, out.density);
    case 3:
      return average<3>(fluid.smoke(), n, out.density);
    case 4:
      return average<4>(fluid.smoke(), n, out.density);
    default:
      return average<5>(fluid.smoke(), n, out.density);
  }
}

void Snapshots::step(const WorldFrame& frame, const WorldStage& stage) {
  StepSnapshot& s = step_.draft();
  s.step = frame.step;
  s.time = frame.taken;
  s.hands = frame.hands;
  s.X_DT = stage.tracker_pose();
  s.recording_time = stage.hands().recording_time();
  s.track_time = frame.track_time;
  s.hand_time = frame.hand_time;
  s.world_time = frame.world_time;
  step_.publish();
}

void Snapshots::smoke(const World& world) {
  if (!watched() || world.fluid() == nullptr) return;
  view_smoke(*world.fluid(), smoke_.draft());
  smoke_.publish();
}

void Snapshots::plan(const WorldFrame& contact, const PlanFrame& plan, double latency) {
  PlanSnapshot& s = plan_.draft();
  s.id = plan.id;
  s.step = contact.step;
  s.planned = plan.status == PlanStatus::Planned;
  s.target = contact.target;
  s.plan = plan.plan;
  s.settings = settings_;
  s.full_scale_pressure = plan.full_scale_pressure;
  s.emission_rate = plan.emission_rate;
  s.gate = plan.gate;
  s.contact_time = contact.contact_time;
  s.plan_time = plan.plan_time;
  s.lift_time = plan.lift_time;
  s.latency = latency;
  if (std::isfinite(latency)) latencies_.push(latency);
  plan_.publish();
}

void render(const PlanSnapshot& plan, RenderedPlan& out) {
  out.metrics = out.metrics_at_setting = {};
  out.max_target = 0.0;
  SegmentPressures played;
  if (plan.planned) {
    EmitSettings emit = plan.settings->emit;
    emit.full_scale_pressure = plan.full_scale_pressure;
    played = played_pressures(plan.plan, plan.target, emit, plan.emission_rate);
  }
  double most = 0.0;
  for (std::size_t i = 0; i < plan.target.patches.size(); ++i) {
    const TargetField& target = plan.target.patches[i];
    const int patch = static_cast<int>(i);
    out.field[i].assign(target.size(), 0.0);
    out.max_target = std::max(out.max_target, max_pressure(target));
    if (!plan.planned) continue;
    const double sigma = sigma_of(*plan.settings, target);
    const GainLaw gain = plan.settings->plan.gain_law();
    quasi_static_field(plan.plan, patch, target, sigma, gain, out.field[i], &played);
    const double pressure = total_pressure(target);
    if (!(pressure > most)) continue;
    most = pressure;
    out.sigma = sigma;
    out.patch = patch;
    out.metrics = score_field(target, out.field[i], plan_coverage(target, plan.plan, patch, sigma));
    const double setting = plan.settings->sigma();
    out.metrics_at_setting = setting == sigma
                                 ? out.metrics
                                 : score_plan(target, plan.plan, patch, setting, gain, &played);
  }
}

}  // namespace prostm
