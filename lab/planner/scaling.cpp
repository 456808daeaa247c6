#include "planner/scaling.hpp"

#include <fmt/core.h>

#include <cmath>
#include <string>

#include "prostm/fields/fields.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/textbook/textbook.hpp"

namespace prostm::bench {
namespace {

/// Counts the points to plan for: on skin, with at least the share of the maximum that counts.
int target_points(const TargetField& field) {
  const double least = PlanSettings{}.weak_pressure * max_pressure(field);
  int count = 0;
  for (std::size_t i = 0; i < field.size(); ++i) {
    count += field.skin[i] != 0 && field.pressure[i] >= least ? 1 : 0;
  }
  return count;
}

/// Measures the times of every planner at one size [µs]; the last is the textbook's.
std::vector<Summary> times_at(const TargetField& field, int paths, int repeats) {
  std::vector<Contender> contenders = presets(paths);
  for (Contender& contender : contenders) contender.begin(field.size());
  std::vector<Distribution> times(contenders.size() + 1);
  for (int repeat = 0; repeat < repeats; ++repeat) {
    Plan plan;
    PlanStats stats;
    for (std::size_t c = 0; c < contenders.size(); ++c) {
      contenders[c].plan(field, plan, stats);
      times[c].add(1e6 * stats.total);
    }
    PlanSettings settings;
    settings.paths = paths;
    settings.seed = repeat + 1;
    textbook::plan(field, settings, plan, stats);
    times.back().add(1e6 * stats.total);
  }
  std::vector<Summary> out;
  for (const Distribution& d : times) out.push_back(d.summary());
  return out;
}

/// A table with a line for each size.
struct Table {
  std::string quantity;            // the varied quantity
  std::vector<std::string> names;  // names of the planners
  std::vector<double> sizes;
  std::vector<std::vector<Summary>> times;  // [size][planner]

  void print() const {
    fmt::print(
        "\nTime against the number of {}, p50 us; slope of its logarithm at the large end\n{:>12}",
        quantity, quantity);
    for (const std::string& name : names) fmt::print(" {:>14}", name);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      fmt::print("\n{:>12.0f}", sizes[i]);
      for (const Summary& t : times[i]) fmt::print(" {:>14.1f}", t.p50);
    }
    // d log t / d log n between the largest size and the largest one of at most a third of it
    std::size_t third = sizes.size() - 1;
    while (third > 0 && sizes[third] > sizes.back() / 3.0) --third;
    fmt::print("\n{:>12}", "slope");
    for (std::size_t p = 0; p < names.size(); ++p) {
      fmt::print(" {:>14.2f}", std::log(times.back()[p].p50 / times[third][p].p50) /
                                   std::log(sizes.back() / sizes[third]));
    }
    fmt::print("\n");
  }

  Chart chart(bool logarithmic) const {
    Chart chart{"Time against the number of " + quantity,
                "number of " + quantity,
                "median time / µs",
                logarithmic,
                {}};
    for (std::size_t p = 0; p < names.size(); ++p) {
      ChartSeries series{names[p], sizes, {}};
      for (const std::vector<Summary>& at : times) series.y.push_back(at[p].p50);
      chart.series.push_back(series);
    }
    return chart;
  }

  void append(std::vector<Row>& rows) const {
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      for (std::size_t p = 0; p + 1 < names.size(); ++p) {
        rows.push_back({fmt::format("planner/{}/{:.0f} {}", names[p], sizes[i], quantity), "us",
                        times[i][p], names.back(), times[i].back().p50});
      }
    }
  }
};

std::vector<std::string> planner_names() {
  std::vector<std::string> names;
  for (const Contender& preset : presets()) names.push_back(preset.name());
  names.emplace_back("textbook");
  return names;
}

}  // namespace

void measure_scaling(const std::string& figure, std::vector<Row>& rows) {
  constexpr int kRepeats = 5;
  // pressure covers 38 % of one plume's raster: from 10³ points to 10⁵
  Table points{"target points", planner_names(), {}, {}};
  for (const int cells : {52, 91, 162, 288, 516}) {
    const TargetField field = fields::make(fields::Pattern::OnePlume, 0, cells);
    points.sizes.push_back(target_points(field));
    points.times.push_back(times_at(field, PlanSettings{}.paths, kRepeats));
  }
  points.print();
  Table paths{"paths", planner_names(), {}, {}};
  for (int n = 1; n <= kMaxPaths; ++n) {
    paths.sizes.push_back(n);
    paths.times.push_back(times_at(fields::make(fields::Pattern::OnePlume, 0), n, kRepeats));
  }
  paths.print();
  points.append(rows);
  paths.append(rows);
  if (!figure.empty()) draw_charts({points.chart(true), paths.chart(false)}, figure);
}

}  // namespace prostm::bench
