#include "prostm/pipeline/snapshot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "prostm/emit/played.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// σ used for planning a patch [m].
double sigma_of(const PipelineSettings& settings, const TargetField& target) {
  const bool by_place = settings.array_width && settings.method != Method::Am;
  return by_place ? settings.plan.sigma_on(target) : settings.sigma();
}

/// The force of pressures on square cells [N]; NaN without pressures.
double force_of(const std::vector<double>& pressures, double cell) {
  if (pressures.empty()) return kNone;
  return cell * cell * std::accumulate(pressures.begin(), pressures.end(), 0.0);
}

/// The boundaries of n blocks of cells along an edge.
struct Blocks {
  explicit Blocks(std::size_t all) : cells(all) {
    const std::size_t widest = (cells + kVolumeViewCells - 1) / kVolumeViewCells;
    n = (cells + widest - 1) / widest;
    for (std::size_t i = 0; i <= n; ++i) edges[i] = i * cells / n;
  }
  std::size_t width(std::size_t i) const { return edges[i + 1] - edges[i]; }

  std::size_t cells, n = 0;
  std::array<std::size_t, kVolumeViewCells + 1> edges = {};
};

/// Averages over blocks. @pre densities are between 0 and 1.
void average(const World& world, const Blocks& blocks, std::span<std::uint8_t> out) {
  const auto& edges = blocks.edges;
  std::array<float, FluidSettings::kMostCells> row;  // sums over the rows of a row of blocks
  auto to = out.begin();
  for (std::size_t k = 0; k < blocks.n; ++k) {
    for (std::size_t j = 0; j < blocks.n; ++j) {
      row.fill(0.0F);
      for (std::size_t z = edges[k]; z < edges[k + 1]; ++z) {
        for (std::size_t y = edges[j]; y < edges[j + 1]; ++y) {
          const auto from = world.seen_row(static_cast<int>(y), static_cast<int>(z)).density;
          for (std::size_t x = 0; x < from.size(); ++x) row[x] += from[x];
        }
      }
      for (std::size_t i = 0; i < blocks.n; ++i, ++to) {
        float sum = 0.0F;
        for (std::size_t x = edges[i]; x < edges[i + 1]; ++x) sum += row[x];
        const auto count = static_cast<float>(blocks.width(k) * blocks.width(j) * blocks.width(i));
        // via int: float to int is one instruction, float to uint8 is not
        *to = static_cast<std::uint8_t>(
            static_cast<int>(std::min(255.0F * sum / count + 0.5F, 255.0F)));
      }
    }
  }
}

}  // namespace

void view_volume(const World& world, VolumeView& out) {
  const GridShape& grid = world.grid();
  const Blocks blocks(static_cast<std::size_t>(grid.nx));
  out.n = static_cast<int>(blocks.n);
  out.p_DF = grid.p_DF;
  out.edge = grid.cell * grid.nx;
  out.density.resize(blocks.n * blocks.n * blocks.n);
  average(world, blocks, out.density);
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

void Snapshots::volume(const World& world) {
  if (!watched() || world.seen_row(0, 0).density.empty()) return;
  view_volume(world, volume_.draft());
  volume_.publish();
}

void Snapshots::plan(const WorldFrame& contact, const PlanFrame& plan, double latency) {
  PlanSnapshot& s = plan_.draft();
  s.id = plan.id;
  s.step = contact.step;
  s.planned = plan.status == PlanStatus::Planned;
  s.target = contact.target;
  s.plan = plan.plan;
  s.played = plan.played;
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
  out.max_target = out.force = 0.0;
  out.smoke_force = out.movement_force = plan.target.patches.empty() ? kNone : 0.0;
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
    out.force += force_of(target.pressure, target.cell);
    out.smoke_force += force_of(target.smoke, target.cell);
    out.movement_force += force_of(target.movement, target.cell);
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
