#include "prostm/study/task/protocol_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/pipeline/world_kinds.hpp"
#include "prostm/study/extra/extra_trials.hpp"
#include "prostm/study/task/detail/settle_level.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

/// [trials], with the task looked up by name among the known tasks.
class TrialTable {
 public:
  /// @pre `trials` outlives this, and its task is one of `tasks`.
  TrialTable(TrialSettings& trials, Tasks tasks) : trials_(trials), tasks_(tasks) {
    for (const Task* task : tasks) names_.push_back(task->traits().name);
  }
  void visit(SettingsReader& v) const {
    v.choice(kTask, names_, place());
    std::as_const(trials_).visit(v);
  }
  void visit(SettingsWriter& v) {
    int index = place();
    v.choice(kTask, names_, index);
    trials_.task = tasks_[static_cast<std::size_t>(index)];
    trials_.visit(v);
  }

 private:
  static constexpr Setting kTask = {.name = "task", .help = "the participant's task in a trial"};

  int place() const {
    return static_cast<int>(std::find(tasks_.begin(), tasks_.end(), trials_.task) - tasks_.begin());
  }

  TrialSettings& trials_;
  Tasks tasks_;
  std::vector<std::string_view> names_;
};

/// Leaves out newer settings that are not used, so that files of earlier versions, which lack them,
/// belong to the same protocol.
void leave_out_defaults(const Protocol& protocol, nlohmann::ordered_json& json) {
  nlohmann::ordered_json& trials = json["trials"];
  if (!protocol.trials.fixed_duration) trials.erase("fixed_duration");
  if (protocol.trials.catch_every == 0) trials.erase("catch_every");
  if (protocol.trials.attention_every == 0) trials.erase("attention_every");
  if (protocol.practice.trials > 0)
    json["practice"] = settings_to_json({group_of("practice", protocol.practice)})["practice"];
}

/// The names in a table of the protocol. @throws InputError: fewer than `least`.
std::vector<std::string> names_in(std::string_view text, const std::string& file,
                                  const std::string& table, std::size_t least) {
  std::vector<std::string> names = tables_in_toml(text, file, table);
  if (names.size() < least) {
    throw InputError(fmt::format("{} has {} [{}.NAME]; a study needs at least {}", file,
                                 names.size(), table, least));
  }
  return names;
}

/// @throws InputError: a method sets what belongs to scenes, or what cannot change during a run.
void refuse_settings_of_the_run(const std::vector<std::string>& given, const std::string& file,
                                const std::string& method) {
  for (const char* fixed : {"pipeline.world", "pipeline.scene", "pipeline.device", "pipeline.array",
                            "pipeline.tracker", "pipeline.world_rate", "pipeline.threads"}) {
    if (std::find(given.begin(), given.end(), fixed) == given.end()) continue;
    throw InputError(fmt::format(
        "{}: [method.{}] sets {}, which is fixed for all trials; set it on the command line, and "
        "scenes as [scene.NAME]",
        file, method, fixed));
  }
}

StudyScene read_scene(std::string_view text, const std::string& file, const std::string& name,
                      std::span<const WorldScene> known) {
  if (std::ranges::find(known, name, &WorldScene::name) == known.end()) {
    std::vector<std::string_view> names;
    for (const WorldScene& scene : known) names.push_back(scene.name);
    throw InputError(fmt::format("{}: there is no scene for [scene.{}]; scenes are {}", file, name,
                                 fmt::join(names, ", ")));
  }
  StudyScene scene{name, {}};
  settings_from_toml(text, file, {group_of(name, scene)}, {"scene"},
                     tables_in_toml(text, file, "scene"));
  if (scene.question.empty()) {
    throw InputError(fmt::format(
        "{}: [scene.{}] has no question; give e.g. question = \"Is there one plume of smoke?\"",
        file, name));
  }
  return scene;
}

}  // namespace

Protocol protocol_from_toml(std::string_view text, const std::string& file,
                            const PipelineSettings& base, Tasks tasks) {
  Protocol protocol;
  protocol.trials.task = tasks.front();
  TrialTable trials(protocol.trials, tasks);
  const auto given_above = settings_from_toml(
      text, file,
      {group_of("study", protocol.study), group_of("training", protocol.training),
       group_of("practice", protocol.practice), group_of("trials", trials),
       group_of("markers", protocol.markers), group_of("level", protocol.level)},
      {}, {"method", "scene"});
  const Task& task = *protocol.trials.task;
  const std::span<const WorldScene> known = world_named(base.world).scenes();
  for (const std::string& name : names_in(text, file, "scene", task.traits().least_scenes))
    protocol.scenes.push_back(read_scene(text, file, name, known));
  for (const std::string& name : names_in(text, file, "method", 1)) {
    StudyMethod& method = protocol.methods.emplace_back(StudyMethod{name, base});
    const auto given =
        settings_from_toml(text, file, settings_groups(method.settings), {"method", name});
    protocol.warnings.insert(protocol.warnings.end(), given.warnings.begin(), given.warnings.end());
    refuse_settings_of_the_run(given.names, file, name);
    study::require_playable_method(method, file, text);
  }
  study::settle_level(given_above.names, file, text, protocol);
  try {
    validate_extra_trials(protocol);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
  const std::size_t conditions = protocol.methods.size() * protocol.scenes.size();
  if (protocol.markers.conditions && conditions > kMostMarkedConditions) {
    throw InputError(fmt::format(
        "{}: markers.conditions needs a code for each of {} conditions (methods times scenes), but "
        "there are {} codes; leave it out, or use fewer conditions",
        file, conditions, kMostMarkedConditions));
  }
  return protocol;
}

Protocol read_protocol(const std::string& path, const PipelineSettings& base, Tasks tasks) {
  return protocol_from_toml(read_file(path, kMaxBytes), path, base, tasks);
}

nlohmann::ordered_json protocol_json(const Protocol& protocol) {
  const Task* const task = protocol.trials.task;
  TrialSettings settings = protocol.trials;
  const TrialTable trials(settings, {&task, 1});
  nlohmann::ordered_json json =
      settings_to_json({group_of("study", protocol.study), group_of("training", protocol.training),
                        group_of("trials", trials), group_of("markers", protocol.markers)});
  leave_out_defaults(protocol, json);
  for (const StudyScene& scene : protocol.scenes)
    json["scene"][scene.name] = {{"question", scene.question}};
  for (const StudyMethod& method : protocol.methods)
    json["method"][method.name] = settings_to_json(study_settings_groups(method.settings));
  if (!protocol.trials.task->traits().has_levels) return json;
  json["level"] = settings_to_json({group_of("level", protocol.level)})["level"];
  if (const auto& standard = protocol.standard)
    json["method"][standard->name] = settings_to_json(study_settings_groups(standard->settings));
  return json;
}

}  // namespace prostm
