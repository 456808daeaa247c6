#include <filesystem>

#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/io/digitised_figure.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "report/report.hpp"

namespace prostm::app {
namespace {

constexpr ReportPart kParts[] = {
    {"about", "What this is", 0.1, 0.1, true, make_about},
    {"scenes", "The fields", 20, 5, false, make_scenes},
    {"table-1", "Table I", 40, 1, false, make_table_one},
    {"figure-1", "Fig. 1: a scene", 2, 2, false, make_figure_one},
    {"figure-2", "Fig. 2: the steps of the algorithm", 1, 1, true, make_figure_two},
    {"figure-3", "Fig. 3: PRO-STM and AM", 1, 1, false, make_figure_three},
    {"figure-4", "Fig. 4: the study", 1, 1, true, make_figure_four},
    {"models", "Models that do the study", 50, 6, true, make_models},
    {"methods", "AM and PRO-STM on the array and on the skin", 170, 14, false, make_methods},
    {"gallery", "Generated targets", 30, 10, false, make_gallery},
    {"skin", "Experiments on skin", 40, 4, false, make_skin},
    {"fluid", "The smoke", 8, 2, false, make_fluid},
    {"solvers", "Focal points", 1, 0.2, false, make_solvers},
    {"latency", "Latency", 11, 4, false, make_latency},
    {"deviations", "Where prostm departs from the paper", 0.1, 0.1, false, make_deviations},
    {"machine", "Machine, version, seeds", 1, 0.5, false, make_machine},
};

}  // namespace

std::span<const ReportPart> report_parts() {
  return kParts;
}

std::optional<std::string> ReportWork::paper_file(const std::string& name) const {
  const std::string file = paper_data + "/" + name;
  if (paper_data.empty() || !std::filesystem::exists(file)) return std::nullopt;
  return read_file(file);
}

void check_paper_data(const ReportWork& work) {
  if (const auto scores = work.paper_file("fig4.json"))
    answers_from_paper(*scores, work.paper_data + "/fig4.json");
  const auto steps = work.paper_file("fig2.json");
  if (!steps || !work.paper_file("fig2.field.json")) return;
  const TargetField target = read_field(work.paper_data + "/fig2.field.json", {});
  const PlanSettings paper;
  digitised_figure_from_json(*steps, work.paper_data + "/fig2.json", target, paper.gain_law(),
                             paper.speed);
}

PipelineSettings ReportWork::settings(const std::string& scene) const {
  PipelineSettings settings;
  settings.scene = scene;
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Random random(static_cast<std::uint64_t>(seed));
  settings.scripted_hand.seed = seed;
  settings.scripted_hand.jitter = 0.3e-3;
  settings.scripted_hand.height = random.uniform(0.19, 0.22);
  settings.scripted_hand.period = random.uniform(17.0, 23.0);
  return settings;
}

std::unique_ptr<HandSource> ReportWork::hand(const PipelineSettings& settings) const {
  return make_scripted_hand(settings.scripted_hand, settings.track);
}

RecordingReader recorded_fields(const ReportWork& work, const std::string& scene) {
  return RecordingReader(work.folder.path(scene + ".h5"));
}

TargetField recorded_field(const RecordingReader& recording, int frame) {
  return recording.frame(frame).patches.at(0);
}

}  // namespace prostm::app
