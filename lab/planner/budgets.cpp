#include "planner/budgets.hpp"

#include <fmt/core.h>

#include "prostm/core/stage_timer.hpp"
#include "prostm/fields/fields.hpp"
#include "prostm/plan/planner.hpp"

namespace prostm::bench {
namespace {

constexpr int kScored = 20;  // frames per field

/// Times [ms], and the number of those over the budget.
struct Times {
  Distribution times;
  int count = 0, over = 0;

  void add(double seconds, double budget) {
    times.add(1e3 * seconds);
    ++count;
    over += seconds > budget ? 1 : 0;
  }
  Row row(const std::string& name, double budget) const {
    const Summary s = times.summary();
    const double share = static_cast<double>(over) / count;
    fmt::print("{:>5.0f} ms  {:<28} {:>8.3f} {:>8.3f} {:>8.3f} {:>9.1f} %\n", 1e3 * budget, name,
               s.p50, s.p99, s.max, 1e2 * share);
    return {fmt::format("planner/budget {:.0f} ms/{}", 1e3 * budget, name), "ms", s, "", 0.0};
  }
};

void measure(double budget, int repeats, std::vector<Row>& rows) {
  PlanSettings settings;
  settings.budget = budget;
  Planner planner(settings, static_cast<std::size_t>(fields::kCells) * fields::kCells);
  Times plans, watcher;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    for (const fields::Pattern pattern : fields::kPatterns) {
      for (int i = 0; i < kScored; ++i) {
        const TargetField field = fields::make(pattern, i * fields::kFrames / kScored);
        Plan plan;
        PlanStats stats;
        planner.reset();
        StageTimer timer;
        planner.plan(field, plan, stats);
        plans.add(timer.lap(), budget);
        while (timer.seconds() < 0.97 * budget) {
        }
        watcher.add(timer.seconds(), budget);
      }
    }
  }
  rows.push_back(plans.row("best, cold", budget));
  rows.push_back(watcher.row("a loop that watches the clock", budget));
}

}  // namespace

void measure_budgets(std::vector<Row>& rows) {
  fmt::print(
      "\nBudgets: time of a plan, beside a loop that ends at 97 % of the budget\n{:>8}  {:<28} "
      "{:>8} {:>8} {:>8} {:>11}\n",
      "budget", "", "p50 ms", "p99 ms", "max ms", "over it");
  measure(1e-3, 5, rows);
  measure(20e-3, 1, rows);
}

}  // namespace prostm::bench
