/// Table I of the paper on generated fields: stage times and quality of the textbook planner and of
/// this one.
///
/// usage: planner_bench [--json FILE]

#include <fmt/core.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "core/distribution.hpp"
#include "fields/fields.hpp"
#include "plan/planner.hpp"
#include "report.hpp"
#include "score/score.hpp"
#include "textbook/textbook.hpp"

namespace prostm {
namespace {

struct Stage {
  const char* name;
  double PlanStats::*time;
};
constexpr std::array kStages{
    Stage{"init", &PlanStats::init},         Stage{"k-means", &PlanStats::kmeans},
    Stage{"tour", &PlanStats::tour},         Stage{"split", &PlanStats::split},
    Stage{"resample", &PlanStats::resample}, Stage{"refine", &PlanStats::refine},
    Stage{"total", &PlanStats::total}};

/// One planner that is measured: its times by stage [µs] and the sums of its quality.
struct Contender {
  std::string name;
  std::function<void(const TargetField&, Plan&, PlanStats&)> plan;
  std::vector<Distribution> times = std::vector<Distribution>(kStages.size());
  Metrics sum{};
  int frames = 0;

  void measure(const TargetField& field, const PlanSettings& settings) {
    Plan result;
    PlanStats stats;
    plan(field, result, stats);
    for (std::size_t s = 0; s < kStages.size(); ++s) times[s].add(1e6 * stats.*kStages[s].time);
    const Metrics m = score_plan(field, result, 0, settings.sigma, settings.gain);
    sum.rmse += m.rmse;
    sum.correlation += m.correlation;
    sum.coverage += m.coverage;
    sum.skill_0 += m.skill_0;
    sum.skill_8 += m.skill_8;
    ++frames;
  }
};

std::vector<Contender> contenders(const PlanSettings& settings, std::vector<Planner>& planners) {
  std::vector<Contender> list;
  list.push_back({"textbook", [settings](const TargetField& field, Plan& plan, PlanStats& stats) {
                    textbook::plan(field, settings, plan, stats);
                  }});
  for (Planner& planner : planners) {
    list.push_back({planner.settings().preset,
                    [&planner](const TargetField& field, Plan& plan, PlanStats& stats) {
                      planner.plan(field, plan, stats);
                    }});
  }
  return list;
}

void print(const std::string& pattern, const std::vector<Contender>& list) {
  fmt::print("\n{} ({} frames), times in µs\n{:<12} {:<9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", pattern,
             list[0].frames, "planner", "stage", "mean", "sd", "p50", "p99", "max");
  for (const Contender& c : list) {
    for (std::size_t s = 0; s < kStages.size(); ++s) {
      const Summary t = c.times[s].summary();
      fmt::print("{:<12} {:<9} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n",
                 s == 0 ? c.name : "", kStages[s].name, t.mean, t.deviation, t.p50, t.p99, t.max);
    }
  }
  fmt::print("{:<12} {:>9} {:>11} {:>9} {:>9} {:>9}\n", "quality", "RMSE", "correlation",
             "coverage", "skill_0", "skill_8");
  for (const Contender& c : list) {
    const double n = c.frames;
    fmt::print("{:<12} {:>9.4f} {:>11.3f} {:>9.3f} {:>9.3f} {:>9.3f}\n", c.name, c.sum.rmse / n,
               c.sum.correlation / n, c.sum.coverage / n, c.sum.skill_0 / n, c.sum.skill_8 / n);
  }
}

/// Each planner's total beside the textbook's.
void append_rows(const std::string& pattern, const std::vector<Contender>& list,
                 std::vector<bench::Row>& rows) {
  const Summary textbook = list[0].times.back().summary();
  for (std::size_t c = 1; c < list.size(); ++c) {
    rows.push_back({fmt::format("planner/{}/{}", list[c].name, pattern), "us",
                    list[c].times.back().summary(), list[0].name, textbook.p50});
  }
}

std::vector<bench::Row> measure() {
  constexpr int kFrames = 100;
  const PlanSettings settings;
  std::vector<Planner> planners;
  for (const char* preset : {"paper", "paper-valid"}) {
    PlanSettings own = settings;
    own.preset = preset;
    planners.emplace_back(own, fields::kCells * fields::kCells);
  }
  std::vector<bench::Row> rows;
  for (const fields::Pattern pattern : fields::kPatterns) {
    // frame by frame in turn, so that what else the machine does weighs on all alike
    std::vector<Contender> list = contenders(settings, planners);
    for (int frame = 0; frame < kFrames; ++frame) {
      const TargetField field = fields::make(pattern, frame);
      for (Contender& c : list) c.measure(field, settings);
    }
    print(to_string(pattern), list);
    append_rows(to_string(pattern), list, rows);
  }
  fmt::print("\n");
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure);
}
