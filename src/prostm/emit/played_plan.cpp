#include "prostm/emit/played_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prostm/emit/detail/in_step.hpp"

namespace prostm {
namespace {

constexpr double kRounding = 1e-6;  // of a sample

/// Sets the lap of a path. @param samples of the loop, or of the lap; @param laps in that.
void set_lap(const LiftedPath& path, std::int64_t samples, std::int64_t laps, double sample_rate,
             PlayedPath& out) {
  out.laps = static_cast<int>(laps);
  if (laps == 0) return;
  out.period = static_cast<double>(samples) / (static_cast<double>(laps) * sample_rate);
  out.speed = path.length / out.period;
}

std::string why(const PlayedPath& path, const PlayedPlan& plan) {
  if (path.planned_speed > plan.max_speed)
    return fmt::format("focal points move at {:.4g} m/s at most", plan.max_speed);
  return fmt::format("each path makes whole laps in the plan's loop of {:.2f} ms", 1e3 * plan.loop);
}

}  // namespace

bool PlayedPath::changed(double sample_rate) const {
  // a path at the speed limit is played at kStepMargin of it
  const double margin =
      (1.0 + kRounding) / sample_rate + (1.0 / kStepMargin - 1.0) * planned_period;
  return laps > 0 && std::abs(period - planned_period) > margin;
}

int PlayedPlan::changed_paths() const {
  return static_cast<int>(std::count_if(
      paths.begin(), paths.end(), [&](const PlayedPath& p) { return p.changed(sample_rate); }));
}

PlayedPlan played_plan(const LiftedPlan& plan, double sample_rate, double max_speed) noexcept {
  const double max_step = max_speed / sample_rate * kStepMargin;
  const InStep loop = shared_loop(plan, sample_rate, max_step);
  PlayedPlan out;
  out.loop = static_cast<double>(loop.samples) / sample_rate;
  out.sample_rate = sample_rate;
  out.max_speed = max_speed;
  for (const LiftedPath& path : plan.paths) {
    PlayedPath& played = out.paths.emplace_back();
    if (path.p_D.empty()) continue;
    played.planned_speed = path.speed;
    if (path.speed > kSlowest) played.planned_period = path.length / path.speed;
    if (loop.samples > 0) {
      set_lap(path, loop.samples, with_laps(loop, path, sample_rate, max_step).laps, sample_rate,
              played);
    } else {
      const std::int64_t lap = lap_samples(path, sample_rate, max_step);
      set_lap(path, lap, lap > 1 ? 1 : 0, sample_rate, played);
    }
  }
  return out;
}

void take_played(const PlayedPlan& played, Plan& plan) noexcept {
  std::size_t k = 0;  // index of the lifted path; paths without points are left out
  for (FocalPath& path : plan.paths) {
    if (path.points.empty()) continue;
    const PlayedPath& now = played.paths[k++];
    if (now.laps == 0) continue;
    path.speed = now.speed;
    path.period = now.period;
  }
  if (plan.loop > 0.0) plan.loop = played.loop;
}

std::vector<std::string> played_warnings(const PlayedPlan& played) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < played.paths.size(); ++i) {
    const PlayedPath& path = played.paths[i];
    if (!path.changed(played.sample_rate)) continue;
    warnings.push_back(
        fmt::format("path {} is planned at {:.4g} m/s, {:.2f} ms a lap, and played at {:.4g} m/s, "
                    "{:.2f} ms: {}",
                    i + 1, path.planned_speed, 1e3 * path.planned_period, path.speed,
                    1e3 * path.period, why(path, played)));
  }
  return warnings;
}

}  // namespace prostm
