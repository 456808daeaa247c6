#include "prostm/study/protocol/protocol.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/study/task/detail/settle_level.hpp"

namespace prostm {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 20;

template <class Settings, class V>
void list_study(Settings& s, V& v) {
  v.field({.name = "title", .help = "of the study, for its files and its pages"}, s.title);
  v.field({.name = "participants",
           .least = 1,
           .most = 10000,
           .help = "that are planned; the order is balanced over them"},
          s.participants);
  v.field({.name = "methods", .help = "each participant has one method, or all"}, s.methods);
  v.field({.name = "seed", .least = 0, .help = "of the order of methods and trials"}, s.seed);
  v.field({.name = "blind", .help = "hides from the experimenter what is presented"}, s.blind);
  v.field({.name = "demographics", .help = "asks for an age range, the hand and experience"},
          s.demographics);
  v.field({.name = "consent", .help = "the text to agree to; empty where that is done on paper"},
          s.consent);
}

template <class Settings, class V>
void list_training(Settings& s, V& v) {
  v.field({.name = "seconds",
           .unit = "s",
           .least = 0,
           .most = 3600,
           .help = "before the trials of each method"},
          s.seconds);
  v.field({.name = "picture", .help = "the participant sees the simulation meanwhile"}, s.picture);
}

template <class Settings, class V>
void list_trials(Settings& s, V& v) {
  v.field({.name = "task", .help = "of the participant in a trial"}, s.task);
  v.field({.name = "repeats",
           .least = 1,
           .most = 1000,
           .help = "trials of each scene with each method; staircases end by themselves"},
          s.repeats);
  v.field({.name = "questions", .help = "drawn for each trial, or balanced over a scene's trials"},
          s.questions);
  v.field({.name = "answers", .help = "who enters them"}, s.answers);
  v.field({.name = "noise", .help = "the participant's page plays noise over the array's sound"},
          s.noise);
  v.field({.name = "feedback", .help = "tells the participant whether an answer was right"},
          s.feedback);
  v.field({.name = "break_every", .least = 0, .most = 1000, .help = "trials; 0 for no breaks"},
          s.break_every);
  v.field({.name = "rest",
           .unit = "s",
           .least = 0.1,
           .most = 60,
           .help = "still air before each trial"},
          s.rest);
  v.field({.name = "settle",
           .unit = "s",
           .least = 0.5,
           .most = 60,
           .help = "silence after it, in which the smoke develops"},
          s.settle);
  v.field({.name = "time_limit",
           .unit = "s",
           .least = 0,
           .most = 600,
           .help = "after which a stimulus ends; 0 until the answer"},
          s.time_limit);
  v.field({.name = "strength",
           .least = 0,
           .most = 10,
           .help = "relative difference in strength of a method's scenes that is let pass"},
          s.strength);
  v.field({.name = "gate", .help = "whether a trial waits for the stimulus gate"}, s.gate);
}

template <class Settings, class V>
void list_markers(Settings& s, V& v) {
  v.field({.name = "conditions", .help = "markers tell what is presented, also in a blind study"},
          s.conditions);
}

/// The names in a table of the protocol. @throws InputError: fewer than `least`.
std::vector<std::string> names_in(std::string_view text, const std::string& file,
                                  const std::string& table, std::size_t least) {
  std::vector<std::string> names = tables_in_toml(text, file, table);
  if (names.size() < least) {
    throw InputError(fmt::format("{} has {} [{}.NAME], and a study needs {} at least", file,
                                 names.size(), table, least));
  }
  return names;
}

/// @throws InputError: a method gives what scenes give, or what cannot change during a run.
void refuse_settings_of_the_run(const std::vector<std::string>& given, const std::string& file,
                                const std::string& method) {
  for (const char* fixed : {"pipeline.scene", "pipeline.device", "pipeline.array",
                            "pipeline.tracker", "pipeline.world_rate", "pipeline.threads"}) {
    if (std::find(given.begin(), given.end(), fixed) == given.end()) continue;
    throw InputError(fmt::format(
        "{}: [method.{}] gives {}, which is the same for all trials; give it on the command line, "
        "and scenes as [scene.NAME]",
        file, method, fixed));
  }
}

StudyScene read_scene(std::string_view text, const std::string& file, const std::string& name) {
  const auto known = scenes();
  if (std::none_of(known.begin(), known.end(), [&](const Scene& s) { return s.name == name; })) {
    std::vector<std::string_view> names;
    for (const Scene& scene : known) names.push_back(scene.name);
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

void StudySettings::visit(SettingsReader& v) const {
  list_study(*this, v);
}
void StudySettings::visit(SettingsWriter& v) {
  list_study(*this, v);
}
void TrainingSettings::visit(SettingsReader& v) const {
  list_training(*this, v);
}
void TrainingSettings::visit(SettingsWriter& v) {
  list_training(*this, v);
}
void TrialSettings::visit(SettingsReader& v) const {
  list_trials(*this, v);
}
void TrialSettings::visit(SettingsWriter& v) {
  list_trials(*this, v);
}
void MarkerSettings::visit(SettingsReader& v) const {
  list_markers(*this, v);
}
void MarkerSettings::visit(SettingsWriter& v) {
  list_markers(*this, v);
}

void StudyScene::visit(SettingsReader& v) const {
  v.field({.name = "question", .help = "yes or no, as it is read and shown"}, question);
}
void StudyScene::visit(SettingsWriter& v) {
  v.field({.name = "question", .help = "yes or no, as it is read and shown"}, question);
}

Protocol protocol_from_toml(std::string_view text, const std::string& file,
                            const PipelineSettings& base) {
  Protocol protocol;
  const auto given_above = settings_from_toml(
      text, file,
      {group_of("study", protocol.study), group_of("training", protocol.training),
       group_of("trials", protocol.trials), group_of("markers", protocol.markers),
       group_of("level", protocol.level)},
      {}, {"method", "scene"});
  const bool identifies = protocol.trials.task == StudyTask::Identification;
  for (const std::string& name : names_in(text, file, "scene", identifies ? 2 : 1))
    protocol.scenes.push_back(read_scene(text, file, name));
  for (const std::string& name : names_in(text, file, "method", 1)) {
    StudyMethod& method = protocol.methods.emplace_back(StudyMethod{name, base});
    const auto given =
        settings_from_toml(text, file, settings_groups(method.settings), {"method", name});
    refuse_settings_of_the_run(given, file, name);
    study::require_playable_method(method, file, text);
  }
  study::settle_level(given_above, file, text, protocol);
  const std::size_t conditions = protocol.methods.size() * protocol.scenes.size();
  if (protocol.markers.conditions && conditions > kMostMarkedConditions) {
    throw InputError(fmt::format(
        "{}: markers.conditions is true for {} conditions, methods times scenes, and there are "
        "codes for {}; leave it out, or take fewer",
        file, conditions, kMostMarkedConditions));
  }
  return protocol;
}

Protocol read_protocol(const std::string& path, const PipelineSettings& base) {
  return protocol_from_toml(read_file(path, kMaxBytes), path, base);
}

nlohmann::ordered_json protocol_json(const Protocol& protocol) {
  nlohmann::ordered_json json = settings_to_json(
      {group_of("study", protocol.study), group_of("training", protocol.training),
       group_of("trials", protocol.trials), group_of("markers", protocol.markers)});
  for (const StudyScene& scene : protocol.scenes)
    json["scene"][scene.name] = {{"question", scene.question}};
  for (const StudyMethod& method : protocol.methods)
    json["method"][method.name] = settings_to_json(settings_groups(method.settings));
  if (protocol.trials.task == StudyTask::Identification) return json;
  json["level"] = settings_to_json({group_of("level", protocol.level)})["level"];
  if (const auto& standard = protocol.standard)
    json["method"][standard->name] = settings_to_json(settings_groups(standard->settings));
  return json;
}

}  // namespace prostm
