#pragma once
/// The parts of prostm report. Each computes one subject of the page, and uses nothing of the
/// others except the fields that the first of them recorded.

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "prostm/io/recorder.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/report/part.hpp"
#include "prostm/report/verdict.hpp"

namespace prostm::app {

/// Thrown by `progress` after a signal.
struct ReportStopped {};

/// The options and places that the parts share.
struct ReportWork {
  bool quick = false;
  int seed = 1;
  std::string paper_data;  ///< folder of the paper's figures as data; empty: none
  const report::PartFolder& folder;
  /// Reports the share of the part that is done, 0..1, on any thread. @throws ReportStopped
  std::function<void(double share)> progress;

  /// Returns one value for a full report, another for a quick one, whose page states it.
  /// @param what unit and meaning of the value, in words. @param document of the part; "lowered"
  /// gets a line.
  template <class Value>
  Value full_or_quick(Value full, Value fast, const char* what,
                      nlohmann::ordered_json& document) const {
    if (quick) document["lowered"].push_back(fmt::format("{} instead of {} {}", fast, full, what));
    return quick ? fast : full;
  }
  /// Returns the text of a file of the paper's data, or nothing without it. @throws InputError
  std::optional<std::string> paper_file(const std::string& name) const;
  /// The settings of every part: prostm's own.
  PipelineSettings settings(const std::string& scene) const;
  /// The hand of this report: the scripted one, seen by a tracker with noise, with a height and a
  /// period that follow from the seed.
  std::unique_ptr<HandSource> hand(const PipelineSettings& settings) const;
};

/// The scenes of the paper.
inline constexpr std::array kReportScenes = {"one-plume", "four-plumes"};
/// The fields that the report recorded of a scene. @throws InputError: they cannot be read.
RecordingReader recorded_fields(const ReportWork& work, const std::string& scene);
/// The first patch of a frame.
TargetField recorded_field(const RecordingReader& recording, int frame);

/// Reads all available data of the paper, before any work. @throws InputError for invalid data.
void check_paper_data(const ReportWork& work);

/// A subject of the page.
struct ReportPart {
  const char* name;
  const char* title;
  double seconds, quick_seconds;  ///< about how long it takes on two cores
  bool of_paper;                  ///< whether it reads the paper's data
  /// Adds "values" (all its numbers), "blocks" (what the page shows) and, where numbers differ from
  /// run to run, "timing" (blocks of these) to the document, and writes its pictures.
  void (*make)(const ReportWork& work, nlohmann::ordered_json& document);
};
std::span<const ReportPart> report_parts();

/// The part with which the page opens, from the numbers of all others.
report::Part report_findings(const std::vector<report::Part>& parts, const ReportWork& work);

void make_about(const ReportWork& work, nlohmann::ordered_json& document);
void make_scenes(const ReportWork& work, nlohmann::ordered_json& document);
void make_table_one(const ReportWork& work, nlohmann::ordered_json& document);
void make_figure_one(const ReportWork& work, nlohmann::ordered_json& document);
void make_figure_two(const ReportWork& work, nlohmann::ordered_json& document);
void make_figure_three(const ReportWork& work, nlohmann::ordered_json& document);
void make_figure_four(const ReportWork& work, nlohmann::ordered_json& document);
void make_models(const ReportWork& work, nlohmann::ordered_json& document);
void make_methods(const ReportWork& work, nlohmann::ordered_json& document);
void make_gallery(const ReportWork& work, nlohmann::ordered_json& document);
void make_skin(const ReportWork& work, nlohmann::ordered_json& document);
void make_fluid(const ReportWork& work, nlohmann::ordered_json& document);
void make_solvers(const ReportWork& work, nlohmann::ordered_json& document);
void make_latency(const ReportWork& work, nlohmann::ordered_json& document);
void make_deviations(const ReportWork& work, nlohmann::ordered_json& document);
void make_machine(const ReportWork& work, nlohmann::ordered_json& document);

}  // namespace prostm::app
