#include <fmt/format.h>

#include "bench/field_bench.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;
using Kind = PlannerColumn::Kind;

std::vector<PlannerColumn> planners() {
  return {{"textbook", Kind::Textbook},
          {"prostm, preset paper", Kind::Paths, Preset::Paper},
          {"prostm, preset paper-valid", Kind::Paths, Preset::PaperValid},
          {"prostm, preset best", Kind::Paths, Preset::Best},
          {"prostm, AM", Kind::Foci}};
}

/// A row of times: the mean of each stage, and the spread of the total.
Json time_row(const std::string& planner, const StageTimes& mean, double scale) {
  Json row = {{"planner", planner}};
  for (std::size_t i = 0; i < kPlanStages; ++i)
    row[plan_stages()[i].name] = mean[i] > 0.0 ? Json(scale * mean[i]) : Json(nullptr);
  return row;
}

Json paper_row(const PaperTable& paper) {
  Json row = time_row("the paper, on its machine", paper.mean, 1.0);
  row["deviation"] = paper.deviation[kPlanStages - 1];
  row["p50"] = row["p99"] = row["max"] = nullptr;
  row["marked"] = true;
  return row;
}

Json row_of(const PlannerColumn& column) {
  StageTimes mean{};
  for (std::size_t i = 0; i < kPlanStages; ++i) mean[i] = column.stage[i].summary().mean;
  Json row = time_row(column.name, mean, 1e6);
  const Summary total = column.total();
  row["deviation"] = 1e6 * total.deviation;
  row["p50"] = 1e6 * total.p50;
  row["p99"] = 1e6 * total.p99;
  row["max"] = 1e6 * total.max;
  return row;
}

std::vector<report::Column> time_columns() {
  std::vector<report::Column> columns = {{"planner", "planner"}};
  for (const auto& stage : plan_stages()) columns.push_back({stage.name, stage.name, "µs", 0});
  for (const char* key : {"deviation", "p50", "p99", "max"}) {
    columns.push_back({key, fmt::format("total, {}", key), "µs", 0});
  }
  return columns;
}

Json quality_row(const PlannerColumn& column) {
  return {{"planner", column.name},
          {"fields", column.total().n},
          {"shape", column.skill_0.summary().mean},
          {"spill", column.spill.summary().mean},
          {"rmse", column.rmse.summary().mean},
          {"correlation", column.correlation.summary().mean},
          {"skill_8", column.skill_8.summary().mean},
          {"coverage", column.coverage.summary().mean}};
}

const std::vector<report::Column> kQuality = {{"planner", "planner"},
                                              {"fields", "fields", "", 0},
                                              {"shape", "shape by Eq. (1)"},
                                              {"spill", "spill"},
                                              {"rmse", "RMSE"},
                                              {"correlation", "correlation"},
                                              {"skill_8", "S_8.5"},
                                              {"coverage", "coverage"}};

/// Measures all planners on all fields of a scene. @param begin share of the part done before it.
FieldBench measured(const ReportWork& work, const PipelineSettings& settings,
                    const std::string& scene, int repeats, double begin) {
  const RecordingReader recording = recorded_fields(work, scene);
  FieldBench bench(settings, planners(), repeats);
  for (int f = 0; f < recording.frames(); ++f) {
    bench.measure(recorded_field(recording, f));
    work.progress(begin + 0.5 * (f + 1) / recording.frames());
  }
  return bench;
}

}  // namespace

void make_table_one(const ReportWork& work, Json& document) {
  const int repeats = work.full_or_quick(3, 1, "times of each plan", document);
  document["values"] = {{"repeats", repeats}, {"paper_am_rate", kPaperAmRate}};
  auto& blocks = document["blocks"];
  auto& timing = document["timing"];
  blocks.push_back(report::text_block(
      "How well plans reconstruct the fields by the paper's Eq. (1), as they are played; means "
      "over "
      "the fields on which every planner found something. RMSE is of pressures over the field's "
      "highest. Shape and S_8.5 are 1 for a perfect field and 0 for an even one; for S_8.5 both "
      "are "
      "blurred by 8.5 mm first. AM is listed for its computing time only: the paper calls Eq. (1) "
      "\"not suited for "
      "a "
      "quantitative (e.g., RMSE) comparison of STM and AM\"."));
  timing.push_back(report::text_block(
      "Times on one thread of this machine, the planners in turn, the median of {/values/repeats} "
      "runs on each field; textbook is a plain C++ program that follows the paper line by line. "
      "Preset best makes all of its tries here; in real time it stops after 2 ms (Latency). A dash "
      "means that a planner has no such stage. For AM the paper states about "
      "{/values/paper_am_rate} updates a second."));
  for (std::size_t s = 0; s < kReportScenes.size(); ++s) {
    const std::string scene = kReportScenes[s];
    const PipelineSettings settings = work.settings(scene);
    const FieldBench bench = measured(work, settings, scene, repeats, 0.5 * static_cast<double>(s));
    Json quality = Json::array(), times = Json::array();
    for (const PaperTable& paper : paper_tables()) {
      if (scene == paper.scene) times.push_back(paper_row(paper));
    }
    for (const PlannerColumn& column : bench.columns()) {
      quality.push_back(quality_row(column));
      times.push_back(row_of(column));
    }
    blocks.push_back(report::table_block("Quality, " + scene, kQuality, quality));
    timing.push_back(report::table_block(
        "Table I, " + scene + ": mean of each stage, and the spread of the total", time_columns(),
        times));
  }
  report::add_verdicts(
      blocks, {report::not_comparable("The paper gives no score by Eq. (1) for its fields.")});
  report::add_verdicts(timing,
                       {report::not_comparable(
                           "The paper's times are from another machine and from its own fields.")});
}

}  // namespace prostm::app
