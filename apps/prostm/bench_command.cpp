#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common.hpp"
#include "prostm/am/am_planner.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/emit/played.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/plan/planner.hpp"
#include "prostm/score/score.hpp"
#include "prostm/textbook/textbook.hpp"

namespace prostm::app {
namespace {

constexpr std::size_t kStages = kPlanStages;
using StageTimes = std::array<double, kStages>;  // [s]

/// The paper's Table I [µs] (Intel i7-6820HK, another machine): mean and standard deviation, for
/// scenes named as ours.
struct PaperTable {
  const char* scene;
  std::array<double, kStages> mean, deviation;
};
constexpr PaperTable kPaper[] = {
    {"one-plume", {285, 1548, 2550, 744, 12, 17896, 24303}, {106, 386, 646, 235, 4, 1664, 2256}},
    {"four-plumes", {142, 948, 1224, 324, 10, 11120, 14640}, {59, 338, 554, 179, 4, 3344, 4281}}};

/// The paper on AM: "update rates of roughly 250 Hz on both test scenarios".
constexpr double kPaperAmRate = 250.0;

StageTimes times_of(const PlanStats& s) {
  StageTimes times{};
  for (std::size_t i = 0; i < kStages; ++i) times[i] = value_of(plan_stages()[i], s);
  return times;
}

/// The median of each stage over the repeats of one field.
StageTimes median(const std::vector<StageTimes>& repeats) {
  StageTimes out{};
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    std::vector<double> t;
    for (const StageTimes& times : repeats) t.push_back(times[stage]);
    std::nth_element(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2), t.end());
    out[stage] = t[t.size() / 2];
  }
  return out;
}

/// One planner's times and quality over the fields of a recording.
struct Column {
  explicit Column(std::string planner) : name(std::move(planner)) {}

  std::string name;
  std::array<Distribution, kStages> stage;
  Distribution rmse, correlation, coverage;

  void add(const StageTimes& times, const Metrics& m) {
    for (std::size_t i = 0; i < kStages; ++i) stage[i].add(times[i]);
    rmse.add(m.rmse);
    correlation.add(m.correlation);
    coverage.add(m.coverage);
  }
};

void print_column(std::FILE* out, const Column& column) {
  fmt::print(out, "  {}, as played: mean RMSE {:.3f}, correlation {:.3f}, coverage {:.3f}\n",
             column.name, column.rmse.summary().mean, column.correlation.summary().mean,
             column.coverage.summary().mean);
  fmt::print(out, "    {:<10} {:>9} {:>9} {:>9} {:>9} {:>9}  [us]\n", "", "mean", "sd", "p50",
             "p99", "max");
  for (std::size_t i = 0; i < kStages; ++i) {
    const Summary s = column.stage[i].summary();
    fmt::print(out, "    {:<10} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n",
               plan_stages()[i].name, s.mean * 1e6, s.deviation * 1e6, s.p50 * 1e6, s.p99 * 1e6,
               s.max * 1e6);
  }
}

void print_paper(std::FILE* out, const std::string& scene) {
  for (const PaperTable& table : kPaper) {
    if (scene != table.scene) continue;
    fmt::print(out, "  the paper's Table I, on its own machine:\n    {:<10} {:>9} {:>9}  [us]\n",
               "", "mean", "sd");
    for (std::size_t i = 0; i < kStages; ++i) {
      fmt::print(out, "    {:<10} {:>9.0f} {:>9.0f}\n", plan_stages()[i].name, table.mean[i],
                 table.deviation[i]);
    }
  }
}

/// The row of the paper's Table I that AM would have, as updates a second.
void print_am(std::FILE* out, const Column& am) {
  const Summary t = am.stage[kStages - 1].summary();
  if (t.n == 0) return;
  fmt::print(out,
             "  am: {:.0f} updates a second at the median time, {:.0f} at the 99th percentile; the "
             "paper, on its own machine: about {:.0f}\n"
             "    mean RMSE {:.3f}, correlation {:.3f}, coverage {:.3f}, not to be compared with "
             "those of paths: how the fields are felt differs (docs/am.md)\n",
             1.0 / t.p50, 1.0 / t.p99, kPaperAmRate, am.rmse.summary().mean,
             am.correlation.summary().mean, am.coverage.summary().mean);
}

/// The planner that a stage is compared with.
struct Reference {
  std::string name;
  double p50 = 0.0, mean = 0.0;  // [s]
};

nlohmann::ordered_json stage_row(const std::string& file, const std::string& scene,
                                 const Column& ours, std::size_t stage,
                                 const Reference& reference) {
  const Summary a = ours.stage[stage].summary();
  return {{"name", fmt::format("{}: {} {}", file, ours.name, plan_stages()[stage].name)},
          {"scene", scene},
          {"unit", "us"},
          {"n", a.n},
          {"mean", a.mean * 1e6},
          {"deviation", a.deviation * 1e6},
          {"p50", a.p50 * 1e6},
          {"p99", a.p99 * 1e6},
          {"max", a.max * 1e6},
          {"baseline", reference.name},
          {"baseline_p50", reference.p50 * 1e6},
          {"baseline_mean", reference.mean * 1e6},
          {"ratio", a.p50 > 0.0 ? reference.p50 / a.p50 : std::nan("")}};
}

/// The planners of one recording. With --method am the last alone is measured.
struct Columns {
  Column baseline, ours, am{"am"};
};

void append_rows(nlohmann::ordered_json& rows, const std::string& file, const std::string& scene,
                 const Columns& columns) {
  for (std::size_t i = 0; i < kStages; ++i) {
    const Summary slow = columns.baseline.stage[i].summary();
    if (columns.ours.stage[i].summary().n == 0) continue;
    rows.push_back(
        stage_row(file, scene, columns.ours, i, {columns.baseline.name, slow.p50, slow.mean}));
  }
  if (columns.am.stage[kStages - 1].summary().n == 0) return;
  rows.push_back(stage_row(file, scene, columns.am, kStages - 1,
                           {"the paper's AM", 1.0 / kPaperAmRate, 1.0 / kPaperAmRate}));
}

/// Times and scores the planners on one field, in turn: the median of the repeats counts. A field
/// that one of them finds nothing on is left out for all.
class FieldBench {
 public:
  FieldBench(const PipelineSettings& settings, int repeats)
      : settings_(settings),
        am_alone_(settings.method == Method::Am),
        repeats_(repeats),
        planner_(playable_plan_settings(settings, settings.emission_rate()), kMaxFieldCells),
        am_(settings.am, kMaxFieldCells) {}

  void measure(const TargetField& target, Columns& columns) {
    Plan slow, ours, foci;
    std::vector<StageTimes> slow_times, times, foci_times;
    for (int r = 0; r < repeats_; ++r) {
      PlanStats stats;
      if (!am_alone_) {
        if (textbook::plan(target, settings_.plan, slow, stats) != PlanStatus::Planned) return;
        slow_times.push_back(times_of(stats));
        if (planner_.plan(target, ours, stats) != PlanStatus::Planned) return;
        times.push_back(times_of(stats));
      }
      if (am_.plan(target, foci, stats) != PlanStatus::Planned) return;
      foci_times.push_back(times_of(stats));
    }
    columns.am.add(median(foci_times), score(target, foci, settings_.am.sigma));
    if (am_alone_) return;
    columns.baseline.add(median(slow_times), score(target, slow, settings_.plan.sigma));
    columns.ours.add(median(times), score(target, ours, settings_.plan.sigma));
  }

 private:
  /// Scores the field as it is played.
  Metrics score(const TargetField& target, const Plan& plan, double sigma) const {
    const SegmentPressures played = played_pressures(
        plan, target, emit_settings(settings_, max_pressure(target)), settings_.emission_rate());
    return score_plan(target, plan, 0, sigma, settings_.plan.gain_law(), &played);
  }

  const PipelineSettings& settings_;
  bool am_alone_;
  int repeats_;
  Planner planner_;
  AmPlanner am_;
};

/// Every field of a recording, on this one thread. False when interrupted.
bool measure(const RecordingReader& recording, FieldBench& bench, const Interrupt& interrupt,
             Progress& progress, Columns& columns) {
  for (int f = 0; f < recording.frames(); ++f) {
    const TargetFrame frame = recording.frame(f);
    for (const TargetField& target : frame.patches) bench.measure(target, columns);
    progress.show(f + 1, recording.frames(), "fields");
    if (interrupt.requested()) return false;
  }
  return true;
}

void print_columns(std::FILE* out, const std::string& scene, const Columns& columns) {
  const Summary total = columns.ours.stage[kStages - 1].summary(),
                slow = columns.baseline.stage[kStages - 1].summary();
  if (total.n > 0) {
    print_paper(out, scene);
    print_column(out, columns.baseline);
    print_column(out, columns.ours);
    fmt::print(out, "  textbook / prostm, of the p50 totals: {:.2f}\n", slow.p50 / total.p50);
  } else if (columns.am.stage[0].summary().n > 0) {
    print_column(out, columns.am);
  }
  print_am(out, columns.am);
}

}  // namespace

int bench_command(const BenchOptionsGiven& given) {
  if (given.repeats < 1 || given.repeats > 1000) {
    throw InputError(fmt::format("--repeats {} must be between 1 and 1000", given.repeats));
  }
  const PipelineSettings settings = make_settings(given.common, std::nullopt);
  std::FILE* out = prose(given.common.json);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const Interrupt interrupt;
  for (const std::string& file : given.files) {
    const RecordingReader recording(file);
    Columns columns{Column("textbook"),
                    Column("prostm " + std::string(name_of(settings.plan.preset)))};
    FieldBench bench(settings, given.repeats);
    bool complete = false;
    {
      Progress progress("planning " + file);
      complete = measure(recording, bench, interrupt, progress, columns);
    }
    const auto fields = columns.am.stage[kStages - 1].summary().n;
    if (complete && fields == 0)
      throw InputError(file + ": none of its fields has pressure to plan for");
    fmt::print(
        out, "{} ({}): {} fields, median of {} runs each, one thread, interleaved\n", file,
        recording.attribute("scene").empty() ? "no scene named" : recording.attribute("scene"),
        fields, given.repeats);
    print_columns(out, recording.attribute("scene"), columns);
    append_rows(rows, file, recording.attribute("scene"), columns);
    if (!complete) break;
  }
  write_json(given.common.json, rows);
  say_written(out, given.common.json);
  return interrupt.status();
}

}  // namespace prostm::app
