#include "felt/disturbances.hpp"

#include <algorithm>
#include <cmath>

#include "prostm/core/random.hpp"
#include "prostm/core/units.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/plan_settings.hpp"
#include "prostm/score/disturbance.hpp"

namespace prostm::bench {
namespace {

constexpr int kDraws = 4;

/// Begins a path at the last point before this share of its length.
void begin_at(FocalPath& path, double share) {
  double along = 0.0;
  std::size_t first = 0;
  const std::size_t n = path.points.size();
  while (first + 1 < n) {
    along += (path.points[first + 1] - path.points[first]).norm();
    if (along > share * path.length) break;
    ++first;
  }
  const auto by = static_cast<std::ptrdiff_t>(first);
  std::rotate(path.points.begin(), path.points.begin() + by, path.points.end());
  std::rotate(path.pressure.begin(), path.pressure.begin() + by, path.pressure.end());
}

/// Returns the plan itself if it has no phases to randomise.
std::vector<Play> with_random_phases(const Plan& plan, double size, std::uint64_t seed) {
  const bool in_phase = std::all_of(plan.foci.begin(), plan.foci.end(),
                                    [](const FocalPoint& f) { return f.phase == 0.0; });
  if (plan.paths.empty() && in_phase) return {Play{}};
  Random random(seed);
  std::vector<Play> out(kDraws, Play{plan});
  for (Play& play : out) {
    for (FocalPath& path : play.plan->paths) begin_at(path, size * random.uniform());
    for (FocalPoint& focus : play.plan->foci) {
      const double phase = focus.phase + size * random.uniform();
      focus.phase = phase - std::floor(phase);
    }
  }
  return out;
}

Play displaced(double size) {
  Play out{std::nullopt, {}};
  for (int k = 0; k < kShiftDirections; ++k) {
    const double angle = 2.0 * kPi * k / kShiftDirections;
    out.shifts.emplace_back(size * std::cos(angle), size * std::sin(angle));
  }
  return out;
}

Play with_wrong_pressures(Plan plan, double size, std::uint64_t seed) {
  Random random(seed);
  const auto disturb = [&](double& p) { p *= std::max(0.0, 1.0 + size * random.normal()); };
  for (FocalPath& path : plan.paths)
    std::for_each(path.pressure.begin(), path.pressure.end(), disturb);
  for (FocalPoint& focus : plan.foci) disturb(focus.pressure);
  return {plan};
}

/// Returns the plan itself if its paths already have periods of their own.
Play with_own_periods(Plan plan, const TargetField& target) {
  if (plan.loop == 0.0) return {};
  plan.loop = 0.0;
  for (FocalPath& path : plan.paths) {
    path.speed = PlanSettings().speed;
    path.period = skin_length(path, target) / path.speed;
  }
  return {plan};
}

}  // namespace

std::vector<Disturbed> felt_disturbances(const DisturbanceSizes& sizes) {
  return {{"random phases",
           [sizes](const Plan& plan, const TargetField&, std::uint64_t seed) {
             return with_random_phases(plan, sizes.phase, seed);
           }},
          {"4 mm away", [sizes](const Plan&, const TargetField&,
                                std::uint64_t) { return std::vector{displaced(sizes.shift)}; }},
          {"pressures 10 %",
           [sizes](const Plan& plan, const TargetField&, std::uint64_t seed) {
             return std::vector{with_wrong_pressures(plan, sizes.pressure, seed)};
           }},
          {"own periods", [](const Plan& plan, const TargetField& target, std::uint64_t) {
             return std::vector{with_own_periods(plan, target)};
           }}};
}

}  // namespace prostm::bench
