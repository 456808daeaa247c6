/// The findings of a report, from the files of its parts.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "prostm/acoustics/skin/sensation_level.hpp"
#include "prostm/report/findings.hpp"
#include "report/report.hpp"
#include "study/simulated_study.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;
using Parts = std::vector<report::Part>;

/// Published speeds at which circles are strongest, [Frier 2018].
constexpr report::Published kCircleSpeeds{5.0, 8.0};

const Json& document_of(const Parts& parts, const std::string& name) {
  return std::ranges::find(parts, name, &report::Part::name)->document;
}

/// The rows of the n-th table of a list of blocks that has a column.
const Json& rows_with(const Json& blocks, const std::string& column, std::size_t n = 0) {
  for (const Json& block : blocks) {
    if (!block.contains("table")) continue;
    const Json& columns = block["table"]["columns"];
    const bool has =
        std::ranges::any_of(columns, [&](const Json& c) { return c["key"] == column; });
    if (has && n-- == 0) return block["table"]["rows"];
  }
  throw std::logic_error("no table of the report has a column " + column);
}

const Json& row_where(const Json& rows, const std::string& key, const std::string& value) {
  for (const Json& row : rows)
    if (row[key] == value) return row;
  throw std::logic_error("no row of the report has " + key + " " + value);
}

report::Quality quality(const Json& rows, const std::string& way) {
  const Json& row = row_where(rows, "way", way);
  return {row["shape"], row["felt_shape"], row["felt_strength"]};
}

void add_skin(const Json& skin, std::vector<report::Finding>& out) {
  std::vector<double> peaks;
  for (const Json& row : rows_with(skin["blocks"], "circle")) peaks.push_back(row["peak"]);
  const int skins = skin["values"]["skins"];
  int inside = 0;
  for (const Json& row : rows_with(skin["blocks"], "peaks"))
    if (row["side"] == 3.0 && row["speed"] >= 8.0 && row["speed"] <= 10.0)
      inside = std::max(inside, row["peaks"].get<int>());
  out.push_back(report::squares(inside, skins));
  out.push_back(report::circles(peaks, kCircleSpeeds));
}

void add_methods(const Json& methods, std::vector<report::Finding>& out) {
  const std::string scene = kReportScenes.back();
  const Json& rows = rows_with(methods["blocks"], "felt_shape", kReportScenes.size() - 1);
  const report::Quality best = quality(rows, "best");
  const Json& values = methods["values"];
  out.push_back(report::one_circle(scene, quality(rows, "one circle"), best));
  const SensationInterval interval{values["interval_below"], values["interval_above"],
                                   SoundSource::Measured};
  out.push_back(report::felt_strength(scene, best.felt_level - interval.below,
                                      sensation_words(best.felt_level, interval)));
  out.push_back(report::promised_shape(scene, best));
  out.push_back(
      report::felt_shapes(scene, quality(rows, "preset felt"), best, quality(rows, "AM")));
}

void add_plans(const Json& table, std::vector<report::Finding>& out) {
  const std::string scene = kReportScenes.back();
  const std::size_t last = kReportScenes.size() - 1;
  const Json& shapes = rows_with(table["blocks"], "shape", last);
  const Json& times = rows_with(table["timing"], "total", last);
  const auto time = [&](const char* planner) {
    return 1e-3 * row_where(times, "planner", planner)["total"].get<double>();
  };
  out.push_back(
      report::shapes_by_eq1(scene, row_where(shapes, "planner", "prostm, preset best")["shape"],
                            row_where(shapes, "planner", "prostm, preset paper")["shape"]));
  out.push_back(
      report::plan_times(scene, time("prostm, preset paper"), time("the paper, on its machine")));
}

report::Finding latency_of(const Json& latency) {
  const Json& all = row_where(rows_with(latency["timing"], "mean"), "what", "all");
  const Json& counts = rows_with(latency["timing"], "count");
  const auto count = [&](const char* what) {
    return row_where(counts, "what", what)["count"].get<int>();
  };
  return report::latency({all["p50"], all["p99"], count("steps of the smoke"),
                          count("steps that were skipped"), count("missed blocks")});
}

std::vector<std::string> notes(const Parts& parts, const ReportWork& work) {
  std::vector<std::string> out;
  std::vector<std::string> lowered;
  for (const report::Part& part : parts) {
    for (const Json& one : part.document.value("lowered", Json::array()))
      lowered.push_back(one.get<std::string>());
  }
  if (!lowered.empty())
    out.push_back(fmt::format("This is a quick report, whose numbers are rougher: {}.",
                              fmt::join(lowered, ", ")));
  std::vector<std::string> missing;
  if (!work.paper_file("fig4.json")) missing.push_back("its Fig. 4");
  if (!work.paper_file("fig2.json") || !work.paper_file("fig2.field.json"))
    missing.push_back("half of its Fig. 2");
  if (!missing.empty())
    out.push_back(fmt::format(
        "The paper's own data are not included, so this page lacks {}; --paper-data names the "
        "folder of fig4.json, fig2.json and fig2.field.json.",
        fmt::join(missing, " and ")));
  return out;
}

}  // namespace

report::Part report_findings(const Parts& parts, const ReportWork& work) {
  const Json& models = document_of(parts, "models")["values"];
  std::vector<report::Finding> findings = {
      report::reversal({models["skin_am"], models["skin_pro_stm"]},
                       {100.0 * kStudyMethods[0].of_people, 100.0 * kStudyMethods[1].of_people})};
  add_skin(document_of(parts, "skin"), findings);
  add_methods(document_of(parts, "methods"), findings);
  add_plans(document_of(parts, "table-1"), findings);
  findings.push_back(latency_of(document_of(parts, "latency")));
  return report::findings_part(findings, notes(parts, work), parts);
}

}  // namespace prostm::app
