#include <fmt/format.h>

#include <cmath>

#include "bench/field_bench.hpp"
#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::app {
namespace {

constexpr std::size_t kStages = kPlanStages;

void print_column(std::FILE* out, const PlannerColumn& column) {
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
  for (const PaperTable& table : paper_tables()) {
    if (scene != table.scene) continue;
    fmt::print(out, "  the paper's Table I, on its own machine:\n    {:<10} {:>9} {:>9}  [us]\n",
               "", "mean", "sd");
    for (std::size_t i = 0; i < kStages; ++i) {
      fmt::print(out, "    {:<10} {:>9.0f} {:>9.0f}\n", plan_stages()[i].name, table.mean[i],
                 table.deviation[i]);
    }
  }
}

/// Prints AM's row for the paper's Table I, as updates a second.
void print_am(std::FILE* out, const PlannerColumn& am) {
  const Summary t = am.stage[kStages - 1].summary();
  if (t.n == 0) return;
  fmt::print(out,
             "  am: {:.0f} updates a second at the median time, {:.0f} at the 99th percentile; the "
             "paper, on its own machine: about {:.0f}\n"
             "    mean RMSE {:.3f}, correlation {:.3f}, coverage {:.3f}, not to be compared with "
             "those of paths, since the fields are felt differently (docs/guides/am.md)\n",
             1.0 / t.p50, 1.0 / t.p99, kPaperAmRate, am.rmse.summary().mean,
             am.correlation.summary().mean, am.coverage.summary().mean);
}

/// The planner that a stage is compared with.
struct Reference {
  std::string name;
  double p50 = 0.0, mean = 0.0;  // [s]
};

nlohmann::ordered_json stage_row(const std::string& file, const std::string& scene,
                                 const PlannerColumn& ours, std::size_t stage,
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

/// The planners of one recording: the textbook's, ours and AM; with --method am only the last.
std::vector<PlannerColumn> columns_of(const PipelineSettings& settings) {
  using Kind = PlannerColumn::Kind;
  std::vector<PlannerColumn> columns;
  const Preset preset = settings.plan.preset;
  if (settings.method != Method::Am) {
    columns.emplace_back("textbook", Kind::Textbook);
    columns.emplace_back("prostm " + std::string(name_of(preset)), Kind::Paths, preset);
  }
  columns.emplace_back("am", Kind::Foci);
  return columns;
}

void append_rows(nlohmann::ordered_json& rows, const std::string& file, const std::string& scene,
                 const std::vector<PlannerColumn>& columns) {
  for (std::size_t i = 0; columns.size() > 1 && i < kStages; ++i) {
    const Summary slow = columns[0].stage[i].summary();
    if (columns[1].stage[i].summary().n == 0) continue;
    rows.push_back(stage_row(file, scene, columns[1], i, {columns[0].name, slow.p50, slow.mean}));
  }
  if (columns.back().total().n == 0) return;
  rows.push_back(stage_row(file, scene, columns.back(), kStages - 1,
                           {"the paper's AM", 1.0 / kPaperAmRate, 1.0 / kPaperAmRate}));
}

/// Measures every field of a recording, on this one thread; false when interrupted.
bool measure(const RecordingReader& recording, FieldBench& bench, const Interrupt& interrupt,
             Progress& progress) {
  for (int f = 0; f < recording.frames(); ++f) {
    const TargetFrame frame = recording.frame(f);
    for (const TargetField& target : frame.patches) bench.measure(target);
    progress.show(f + 1, recording.frames(), "fields");
    if (interrupt.requested()) return false;
  }
  return true;
}

void print_columns(std::FILE* out, const std::string& scene,
                   const std::vector<PlannerColumn>& columns) {
  const PlannerColumn& am = columns.back();
  if (columns.size() > 1 && columns[1].total().n > 0) {
    print_paper(out, scene);
    print_column(out, columns[0]);
    print_column(out, columns[1]);
    fmt::print(out, "  textbook / prostm, of the p50 totals: {:.2f}\n",
               columns[0].total().p50 / columns[1].total().p50);
  } else if (am.total().n > 0) {
    print_column(out, am);
  }
  print_am(out, am);
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
    FieldBench bench(settings, columns_of(settings), given.repeats);
    bool complete = false;
    {
      Progress progress("planning " + file);
      complete = measure(recording, bench, interrupt, progress);
    }
    const std::size_t fields = bench.fields();
    if (complete && fields == 0)
      throw InputError(file + ": none of its fields has pressure to plan for");
    fmt::print(
        out, "{} ({}): {} fields, median of {} runs each, one thread, interleaved\n", file,
        recording.attribute("scene").empty() ? "no scene named" : recording.attribute("scene"),
        fields, given.repeats);
    print_columns(out, recording.attribute("scene"), bench.columns());
    append_rows(rows, file, recording.attribute("scene"), bench.columns());
    if (!complete) break;
  }
  write_json(given.common.json, rows);
  say_written(out, given.common.json);
  return interrupt.status();
}

}  // namespace prostm::app
