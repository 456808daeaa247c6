#include "prostm/emit/detail/in_step.hpp"

#include <algorithm>
#include <cmath>

namespace prostm {
namespace {

constexpr double kRounding = 1e-6;  // excess that counts as rounding, as a share

/// Whether a focal point would be at rest on the path.
bool rests(const LiftedPath& path, double step) {
  return path.speed <= kSlowest || path.length <= step * (1.0 + kRounding);
}

}  // namespace

InStep shared_loop(const LiftedPlan& plan, double sample_rate, double max_step) {
  InStep loop;
  if (plan.loop <= 0.0) return loop;
  // rounded up, so that no path becomes faster than planned
  loop.base =
      static_cast<std::int64_t>(std::max(1.0, std::ceil(plan.loop * sample_rate - kRounding)));
  double loops = 1.0;
  for (const LiftedPath& path : plan.paths) {
    if (rests(path, 0.0)) continue;
    const double least = path.length / (max_step * static_cast<double>(loop.base));
    loops = std::max(loops, std::ceil(least - kRounding));
  }
  loop.samples = loop.base * static_cast<std::int64_t>(loops);
  return loop;
}

InStep with_laps(InStep loop, const LiftedPath& path, double sample_rate, double max_step) {
  loop.laps = 0;
  if (loop.samples == 0) return loop;
  const double step = std::min(path.speed / sample_rate, max_step);
  if (rests(path, step)) return loop;
  const auto samples = static_cast<double>(loop.samples);
  const double most = std::floor(samples * max_step / path.length + kRounding);
  const double wanted = std::round(samples * step / path.length);
  loop.laps = static_cast<std::int64_t>(std::max(1.0, std::min(wanted, most)));
  return loop;
}

PathPlace place_in_step(const LiftedPath& path, const InStep& in_step) {
  const std::int64_t n = in_step.samples;
  const std::int64_t count = (in_step.count % n + n) % n;
  const double share = static_cast<double>(count * in_step.laps % n) / static_cast<double>(n);
  PathPlace place;
  place.s = path.length * share;
  place.p_D = point_at(path, place.s).p_D;
  return place;
}

}  // namespace prostm
