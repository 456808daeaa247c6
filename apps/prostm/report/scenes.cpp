#include <fmt/format.h>

#include <algorithm>

#include "field/captured_fields.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/core/input_error.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

constexpr double kFrom = 3.0;  // time by which jets have reached the hand [s]

/// Records a scene. @param begin share of the part that is done before it.
void capture(const ReportWork& work, const std::string& scene, int frames, double begin) {
  const PipelineSettings settings = work.settings(scene);
  Pipeline pipeline(settings, work.hand(settings));
  Recorder recorder(work.folder.path(scene + ".h5"), settings_groups(settings));
  recorder.set_attribute("scene", scene);
  recorder.set_attribute("hand", "scripted");
  const int taken = capture_fields(
      pipeline, settings, recorder, frames,
      [&](int so_far) {
        work.progress(begin + 0.5 * so_far / frames);
        return true;
      },
      kFrom);
  recorder.close();
  if (taken < frames) {
    throw InputError(fmt::format("only {} of {} fields of {} had pressure; try another --seed",
                                 taken, frames, scene));
  }
}

nlohmann::ordered_json row_of(const RecordingReader& recording, const std::string& scene) {
  Distribution skin, pressure;
  for (int f = 0; f < recording.frames(); ++f) {
    const TargetField target = recorded_field(recording, f);
    skin.add(static_cast<double>(std::ranges::count(target.skin, 1)));
    pressure.add(max_pressure(target));
  }
  return {{"scene", scene},
          {"fields", recording.frames()},
          {"first", recording.times().front()},
          {"last", recording.times().back()},
          {"skin", skin.summary().mean},
          {"pressure", pressure.summary().mean},
          {"highest", pressure.summary().max}};
}

}  // namespace

void make_scenes(const ReportWork& work, nlohmann::ordered_json& document) {
  const int frames = work.full_or_quick(500, 20, "fields of each scene", document);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (std::size_t s = 0; s < kReportScenes.size(); ++s) {
    capture(work, kReportScenes[s], frames, 0.5 * static_cast<double>(s));
    rows.push_back(row_of(recorded_fields(work, kReportScenes[s]), kReportScenes[s]));
  }
  const PipelineSettings settings = work.settings(kReportScenes[0]);
  document["values"] = {{"height_mm", 1e3 * settings.scripted_hand.height},
                        {"period_s", settings.scripted_hand.period},
                        {"jitter_mm", 1e3 * settings.scripted_hand.jitter},
                        {"seed", work.seed}};
  document["files"] = {"one-plume.h5", "four-plumes.h5"};
  auto& blocks = document["blocks"];
  blocks.push_back(report::text_block(
      "The tables below use these fields, which this run made. A scripted hand hovers, sinks, "
      "tilts and closes in smoke; a field is the pressure of the smoke on its skin at one update. "
      "Its height "
      "({/values/height_mm:1} mm), its period ({/values/period_s:1} s) and the noise of its "
      "tracker ({/values/jitter_mm:1} mm) follow from seed {/values/seed}. The planner's settings "
      "were chosen on generated fields and on recorded hands, never on this hand, and with another "
      "seed all fields are new."));
  blocks.push_back(report::table_block("Fields with pressure",
                                       {{"scene", "scene"},
                                        {"fields", "fields", "", 0},
                                        {"first", "first", "s", 2},
                                        {"last", "last", "s", 2},
                                        {"skin", "skin, mean", "cells", 0},
                                        {"pressure", "highest smoke pressure, mean", "Pa", 4},
                                        {"highest", "highest smoke pressure of all", "Pa", 4}},
                                       rows));
  report::add_verdicts(
      blocks, {report::not_comparable(
                  "The paper's fields are not published; these are of the same two scenes.")});
}

}  // namespace prostm::app
