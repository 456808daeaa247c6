#include "planner/steadiness.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "planner/as_played.hpp"
#include "prostm/emit/detail/matching.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/quasi_static/closest_point.hpp"
#include "prostm/plan/quasi_static/quasi_static.hpp"

namespace prostm::bench {
namespace {

constexpr std::size_t kArcs = 40;
using Loop = std::array<Vec2, kArcs>;

/// Returns points of the closed path at equal arc lengths.
Loop at_equal_arcs(const FocalPath& path) {
  const std::size_t n = path.points.size();
  const double step = closed_length(path) / kArcs;
  Loop loop;
  std::size_t segment = 0;
  double passed = 0.0;  // arc length at the segment's start
  for (std::size_t k = 0; k < kArcs; ++k) {
    const double target = step * static_cast<double>(k);
    double length = (path.points[(segment + 1) % n] - path.points[segment]).norm();
    while (segment + 1 < n && passed + length < target) {
      passed += length;
      ++segment;
      length = (path.points[(segment + 1) % n] - path.points[segment]).norm();
    }
    const double share = length > 0.0 ? std::clamp((target - passed) / length, 0.0, 1.0) : 0.0;
    loop[k] = (1.0 - share) * path.points[segment] + share * path.points[(segment + 1) % n];
  }
  return loop;
}

double distance(const Loop& a, const Loop& b) {
  double best = std::numeric_limits<double>::max();
  for (const bool reversed : {false, true}) {
    for (std::size_t shift = 0; shift < kArcs; ++shift) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kArcs; ++k) {
        const std::size_t other = reversed ? (shift + kArcs - k) % kArcs : (shift + k) % kArcs;
        sum += (a[k] - b[other]).norm();
      }
      best = std::min(best, sum / kArcs);
    }
  }
  return best;
}

double distance_to_plan(const FocalPath& path, const Plan& plan) {
  PathSegments segments(plan, path.patch);
  double sum = 0.0;
  for (const Vec2& x : path.points) sum += std::sqrt(segments.closest(x).distance2);
  return sum / static_cast<double>(path.points.size());
}

struct Steadiness {
  Distribution motion;  // [m]
  Distribution rmse;
};

Steadiness follow_moved(Contender& contender, fields::Pattern pattern) {
  constexpr int kLast = 59, kFrom = 10;  // one turn of the circle, after the planner has settled
  contender.begin(static_cast<std::size_t>(fields::kMovedCells) * fields::kMovedCells);
  Steadiness out;
  Plan before;
  const PlanSettings& s = contender.settings();
  for (int frame = 0; frame <= kLast; ++frame) {
    const TargetField target = fields::moved(pattern, frame);
    Plan plan;
    PlanStats stats;
    contender.plan(target, plan, stats);
    if (frame >= kFrom) out.motion.add(motion(before, plan));
    if (frame >= kFrom && frame % 5 == 0) {
      out.rmse.add(score_as_played(target, plan, s).rmse);
    }
    before = plan;
  }
  return out;
}

/// Returns the rendered share of the second contact's pressure where it exceeds half its maximum.
double rendered_share(const fields::Appearing& target, const Plan& plan, const PlanSettings& s) {
  std::vector<double> rendered(target.field.size());
  quasi_static_field(plan, 0, target.field, s.sigma, s.gain_law(), rendered);
  const double peak = *std::max_element(target.second.begin(), target.second.end());
  double wanted = 0.0, felt = 0.0;
  for (std::size_t i = 0; i < rendered.size(); ++i) {
    if (target.second[i] <= 0.5 * peak) continue;
    wanted += target.field.pressure[i];
    felt += rendered[i];
  }
  return felt / wanted;
}

constexpr int kPatience = 6;  // updates

/// Counts updates from the first with the second contact to the first that renders it; returns
/// kPatience + 1 if that takes longer.
int updates_to_render(Contender& contender, int which) {
  constexpr int kBefore = 15;
  contender.begin(static_cast<std::size_t>(fields::kCells) * fields::kCells);
  for (int frame = fields::kAppearingFrame - kBefore; frame < fields::kAppearingFrame + kPatience;
       ++frame) {
    const fields::Appearing target = fields::appearing(which, frame);
    Plan plan;
    PlanStats stats;
    contender.plan(target.field, plan, stats);
    if (frame < fields::kAppearingFrame) continue;
    if (rendered_share(target, plan, contender.settings()) >= 0.5) {
      return frame - fields::kAppearingFrame + 1;
    }
  }
  return kPatience + 1;
}

void measure_moved(std::vector<Contender>& contenders, std::vector<Row>& rows) {
  fmt::print(
      "\nSteadiness: mean motion of paths per frame over the field's {:.3f} mm, and RMSE\n"
      "{:<20}",
      1e3 * fields::kMovedStep, "");
  for (const fields::Pattern pattern : fields::kPatterns) fmt::print(" {:>14}", to_string(pattern));
  fmt::print(" {:>14}\n", "mean");
  for (Contender& contender : contenders) {
    Distribution ratio;
    double mean_rmse = 0.0;
    fmt::print("{:<20}", contender.name());
    for (const fields::Pattern pattern : fields::kPatterns) {
      const Steadiness s = follow_moved(contender, pattern);
      const double mean = s.motion.summary().mean / fields::kMovedStep;
      ratio.add(mean);
      mean_rmse += s.rmse.summary().mean / static_cast<double>(fields::kPatterns.size());
      fmt::print(" {:>6.2f}x {:>6.4f}", mean, s.rmse.summary().mean);
      std::fflush(stdout);
    }
    fmt::print(" {:>6.2f}x {:>6.4f}\n", ratio.summary().mean, mean_rmse);
    rows.push_back({fmt::format("planner/{}/motion over displacement", contender.name()),
                    "1",
                    ratio.summary(),
                    {},
                    0.0});
  }
}

void measure_appearing(std::vector<Contender>& contenders, std::vector<Row>& rows) {
  fmt::print("\nA contact that appears: updates until half of its pressure is rendered, {} cases\n",
             fields::kAppearings);
  for (Contender& contender : contenders) {
    Distribution updates;
    fmt::print("{:<20}", contender.name());
    for (int which = 0; which < fields::kAppearings; ++which) {
      const int n = updates_to_render(contender, which);
      updates.add(n);
      fmt::print(" {:>4}", n > kPatience ? fmt::format(">{}", kPatience) : std::to_string(n));
    }
    fmt::print("\n");
    rows.push_back({fmt::format("planner/{}/updates until a contact is rendered", contender.name()),
                    "1",
                    updates.summary(),
                    {},
                    0.0});
  }
}

}  // namespace

double motion(const Plan& before, const Plan& after) {
  const bool grows = after.paths.size() > before.paths.size();
  const Plan &more = grows ? after : before, &fewer = grows ? before : after;
  if (fewer.paths.empty()) return 0.0;
  MatchCosts costs{};  // unpaired paths cost nothing: their number is fixed
  for (std::size_t m = 0; m < more.paths.size(); ++m) {
    const Loop loop = at_equal_arcs(more.paths[m]);
    for (std::size_t f = 0; f < fewer.paths.size(); ++f) {
      costs[m][f] = distance(loop, at_equal_arcs(fewer.paths[f]));
    }
  }
  const auto partner =
      match_paths(costs, static_cast<int>(more.paths.size()), static_cast<int>(fewer.paths.size()));
  double sum = 0.0;
  for (std::size_t m = 0; m < more.paths.size(); ++m) {
    sum += partner[m] == kNoPath ? distance_to_plan(more.paths[m], fewer)
                                 : costs[m][static_cast<std::size_t>(partner[m])];
  }
  return sum / static_cast<double>(more.paths.size());
}

void measure_steadiness(std::vector<Contender>& contenders, std::vector<Row>& rows) {
  measure_moved(contenders, rows);
  measure_appearing(contenders, rows);
}

}  // namespace prostm::bench
