#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common.hpp"
#include "core/input_error.hpp"
#include "io/recorder.hpp"
#include "plan/planner.hpp"
#include "score/score.hpp"
#include "textbook/textbook.hpp"

namespace prostm::app {
namespace {

constexpr int kStages = 7;
constexpr const char* kStageNames[kStages] = {"init",     "kmeans", "tour", "split",
                                              "resample", "refine", "total"};
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

StageTimes times_of(const PlanStats& s) {
  return {s.init, s.kmeans, s.tour, s.split, s.resample, s.refine, s.total};
}

/// The median of each stage over the repeats of one field.
StageTimes median(const std::vector<StageTimes>& repeats) {
  StageTimes out{};
  for (int stage = 0; stage < kStages; ++stage) {
    std::vector<double> t;
    for (const StageTimes& times : repeats) t.push_back(times[static_cast<std::size_t>(stage)]);
    std::nth_element(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(t.size() / 2), t.end());
    out[static_cast<std::size_t>(stage)] = t[t.size() / 2];
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
  fmt::print(out, "  {}: mean RMSE {:.3f}, correlation {:.3f}, coverage {:.3f}\n", column.name,
             column.rmse.summary().mean, column.correlation.summary().mean,
             column.coverage.summary().mean);
  fmt::print(out, "    {:<10} {:>9} {:>9} {:>9} {:>9} {:>9}  [us]\n", "", "mean", "sd", "p50",
             "p99", "max");
  for (int i = 0; i < kStages; ++i) {
    const Summary s = column.stage[static_cast<std::size_t>(i)].summary();
    fmt::print(out, "    {:<10} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f}\n", kStageNames[i],
               s.mean * 1e6, s.deviation * 1e6, s.p50 * 1e6, s.p99 * 1e6, s.max * 1e6);
  }
}

void print_paper(std::FILE* out, const std::string& scene) {
  for (const PaperTable& table : kPaper) {
    if (scene != table.scene) continue;
    fmt::print(out, "  the paper's Table I, on its own machine:\n    {:<10} {:>9} {:>9}  [us]\n",
               "", "mean", "sd");
    for (std::size_t i = 0; i < kStages; ++i) {
      fmt::print(out, "    {:<10} {:>9.0f} {:>9.0f}\n", kStageNames[i], table.mean[i],
                 table.deviation[i]);
    }
  }
}

void append_rows(nlohmann::ordered_json& rows, const std::string& file, const std::string& scene,
                 const Column& ours, const Column& textbook) {
  for (std::size_t i = 0; i < kStages; ++i) {
    const Summary a = ours.stage[i].summary(), b = textbook.stage[i].summary();
    rows.push_back({{"name", fmt::format("{}: {} {}", file, ours.name, kStageNames[i])},
                    {"scene", scene},
                    {"unit", "us"},
                    {"n", a.n},
                    {"mean", a.mean * 1e6},
                    {"deviation", a.deviation * 1e6},
                    {"p50", a.p50 * 1e6},
                    {"p99", a.p99 * 1e6},
                    {"max", a.max * 1e6},
                    {"baseline", textbook.name},
                    {"baseline_p50", b.p50 * 1e6},
                    {"baseline_mean", b.mean * 1e6},
                    {"ratio", a.p50 > 0.0 ? b.p50 / a.p50 : std::nan("")}});
  }
}

/// Plans every field of a recording with both planners, in turn, on this one thread. False when
/// interrupted.
bool measure(const RecordingReader& recording, const PlanSettings& settings, int repeats,
             const Interrupt& interrupt, Progress& progress, Column& ours, Column& baseline) {
  Planner planner(settings, kMaxFieldCells);
  for (int f = 0; f < recording.frames(); ++f) {
    const TargetFrame frame = recording.frame(f);
    for (const TargetField& target : frame.patches) {
      Plan plan, other;
      std::vector<StageTimes> times, other_times;
      bool planned = true;
      for (int r = 0; r < repeats && planned; ++r) {
        PlanStats stats, other_stats;
        planned = textbook::plan(target, settings, other, other_stats) == PlanStatus::Planned &&
                  planner.plan(target, plan, stats) == PlanStatus::Planned;
        times.push_back(times_of(stats));
        other_times.push_back(times_of(other_stats));
      }
      if (planned) {
        ours.add(median(times), score_plan(target, plan, 0, settings.sigma, settings.gain_law()));
        baseline.add(median(other_times),
                     score_plan(target, other, 0, settings.sigma, settings.gain_law()));
      }
    }
    progress.show(f + 1, recording.frames(), "fields");
    if (interrupt.requested()) return false;
  }
  return true;
}

}  // namespace

int bench_command(const BenchOptionsGiven& given) {
  check_outputs(given.common);
  if (given.repeats < 1 || given.repeats > 1000) {
    throw InputError(fmt::format("--repeats {} must be between 1 and 1000", given.repeats));
  }
  const PipelineSettings settings = make_settings(given.common, std::nullopt);
  std::FILE* out = prose(given.common.json);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const Interrupt interrupt;
  for (const std::string& file : given.files) {
    const RecordingReader recording(file);
    Column ours("prostm " + settings.plan.preset), baseline("textbook");
    bool complete = false;
    {
      Progress progress("planning " + file);
      complete =
          measure(recording, settings.plan, given.repeats, interrupt, progress, ours, baseline);
    }
    const Summary total = ours.stage[kStages - 1].summary(),
                  slow = baseline.stage[kStages - 1].summary();
    if (complete && total.n == 0)
      throw InputError(file + ": none of its fields has pressure to plan for");
    fmt::print(out, "{} ({}): {} fields, median of {} runs each, one thread, interleaved\n", file,
               recording.scene().empty() ? "no scene named" : recording.scene(), total.n,
               given.repeats);
    print_paper(out, recording.scene());
    print_column(out, baseline);
    print_column(out, ours);
    if (total.p50 > 0.0)
      fmt::print(out, "  textbook / prostm, of the p50 totals: {:.2f}\n", slow.p50 / total.p50);
    append_rows(rows, file, recording.scene(), ours, baseline);
    if (!complete) break;
  }
  write_json(given.common.json, rows);
  return interrupt.requested() ? kInterrupted : 0;
}

}  // namespace prostm::app
