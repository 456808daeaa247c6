#include <fmt/format.h>

#include <utility>

#include "common.hpp"
#include "prostm/study/task/course.hpp"
#include "prostm/study/task/task.hpp"
#include "study/study_protocol.hpp"

namespace prostm::app {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the stimulus of these settings: the limits of speeds and periods, as played.
Json stimulus_json(const PipelineSettings& s) {
  Json json = {{"method", name_of(s.method)}, {"full_scale_pressure", nullptr}};
  if (s.emit.full_scale_pressure > 0.0) json["full_scale_pressure"] = s.emit.full_scale_pressure;
  if (s.method == Method::Am) {
    const double rate = s.emission_rate();
    json["foci"] = s.am.foci;
    json["frequency_hz"] = rate / am_period(s.emit, rate);
    return json;
  }
  json["preset"] = name_of(s.plan.preset);
  json["paths"] = s.plan.paths;
  json["speed_m_s"] = s.plan.path_speed();
  json["longest_lap_ms"] = 1e3 / s.plan.draw_rate;
  json["longest_path_mm"] = 1e3 * s.plan.max_length();
  json["gain"] = s.plan.gain;
  return json;
}

std::string in_words(const Json& stimulus) {
  const std::string scale =
      stimulus["full_scale_pressure"].is_null()
          ? "full scale of the scene"
          : fmt::format("full scale {:.3g} Pa", stimulus["full_scale_pressure"].get<double>());
  if (stimulus.contains("foci")) {
    return fmt::format("am, up to {} foci at {:.1f} Hz; {}", stimulus["foci"].get<int>(),
                       stimulus["frequency_hz"].get<double>(), scale);
  }
  return fmt::format(
      "pro-stm, preset {}, up to {} paths at {:.2f} m/s, laps of up to {:.1f} ms ({:.0f} mm), gain "
      "{:.3g}; {}",
      stimulus["preset"].get<std::string>(), stimulus["paths"].get<int>(),
      stimulus["speed_m_s"].get<double>(), stimulus["longest_lap_ms"].get<double>(),
      stimulus["longest_path_mm"].get<double>(), stimulus["gain"].get<double>(), scale);
}

/// Returns a method at one level of the varied setting.
Json level_json(const Protocol& protocol, PipelineSettings settings, double level) {
  const double set = set_level(settings, protocol.level.setting, level);
  return {{"level", set}, {"stimulus", stimulus_json(settings)}};
}

Json method_json(const Protocol& protocol, const StudyMethod& method, bool varies) {
  Json json = {{"name", method.name}};
  if (!varies) {
    json["stimulus"] = stimulus_json(method.settings);
    return json;
  }
  json["levels"] = {level_json(protocol, method.settings, protocol.level.low),
                    level_json(protocol, method.settings, protocol.level.high)};
  if (protocol.trials.task->traits().compares && !protocol.standard)
    json["reference"] = level_json(protocol, method.settings, protocol.level.reference);
  return json;
}

Json presented_json(const Protocol& protocol, const PipelineSettings& base) {
  const bool varies = protocol.trials.task->traits().has_levels;
  const Course course(protocol, 1);
  Json json = {{"format", "prostm-study-check/1"},
               {"task", protocol.trials.task->name()},
               {"participants", protocol.study.participants},
               {"methods_of", name_of(protocol.study.methods)},
               {"device", base.device},
               {"trials", course.most()},
               {"trials_may_be_fewer", course.is_open()},
               {"scenes", Json::array()},
               {"methods", Json::array()}};
  for (const StudyScene& scene : protocol.scenes)
    json["scenes"].push_back({{"name", scene.name}, {"question", scene.question}});
  if (varies) json["setting"] = protocol.level.setting;
  for (const StudyMethod& method : protocol.methods)
    json["methods"].push_back(method_json(protocol, method, varies));
  if (protocol.standard) json["standard"] = method_json(protocol, *protocol.standard, false);
  json["protocol"] = protocol_json(protocol);
  return json;
}

void print_method(std::FILE* out, const char* what, const Json& method, const Json& setting) {
  const std::string name = method["name"].get<std::string>();
  if (method.contains("stimulus")) {
    fmt::print(out, "{} {}: {}\n", what, name, in_words(method["stimulus"]));
    return;
  }
  fmt::print(out, "{} {}, {} varied:\n", what, name, setting.get<std::string>());
  const auto print_level = [&](const char* which, const Json& level) {
    fmt::print(out, "  {} {:g}: {}\n", which, level["level"].get<double>(),
               in_words(level["stimulus"]));
  };
  print_level("lowest", method["levels"][0]);
  print_level("highest", method["levels"][1]);
  if (method.contains("reference")) print_level("reference", method["reference"]);
}

/// Prints practice, catch and attention trials, and a fixed duration; nothing without them.
void print_extra_trials(std::FILE* out, const Json& protocol) {
  if (protocol.contains("practice")) {
    const Json& practice = protocol["practice"];
    const double right = practice["right"].get<double>();
    fmt::print(out, "practice: {}{} trials before the trials of each method{}\n",
               right > 0.0 ? "at most " : "", practice["trials"].get<int>(),
               right > 0.0 ? fmt::format(", until {:.0f} % of the last {} answers are right",
                                         100.0 * right, practice["window"].get<int>())
                           : std::string());
  }
  const Json& trials = protocol["trials"];
  for (const auto& [key, name] : {std::pair("catch_every", "catch trial, without a stimulus"),
                                  {"attention_every", "attention trial"}}) {
    if (trials.contains(key))
      fmt::print(out, "one {}, in every {} trials\n", name, trials[key].get<int>());
  }
  if (trials.contains("fixed_duration"))
    fmt::print(out, "answers are taken after the stimulus, whose duration is fixed\n");
}

void print_presented(std::FILE* out, const Json& json) {
  fmt::print(out, "{}, {} participants, each with {}; {}{} trials; played by {}\n",
             json["task"].get<std::string>(), json["participants"].get<int>(),
             json["methods_of"] == "within" ? "all methods" : "one method",
             json["trials_may_be_fewer"].get<bool>() ? "at most " : "",
             json["trials"].get<std::size_t>(), json["device"].get<std::string>());
  print_extra_trials(out, json["protocol"]);
  for (const Json& scene : json["scenes"]) {
    fmt::print(out, "scene {}: \"{}\"\n", scene["name"].get<std::string>(),
               scene["question"].get<std::string>());
  }
  const Json setting = json.value("setting", Json());
  for (const Json& method : json["methods"]) print_method(out, "method", method, setting);
  if (json.contains("standard")) print_method(out, "standard", json["standard"], setting);
}

}  // namespace

int study_check_command(const StudyCheckOptionsGiven& given) {
  const PipelineSettings base = study_settings(given.common);
  const Json json = presented_json(live_protocol(given.protocol, base), base);
  std::FILE* out = prose(given.common.json);
  print_presented(out, json);
  fmt::print(out, "{}: every level is played as it is written.\n", given.protocol);
  write_json(given.common.json, json);
  say_written(out, given.common.json);
  return 0;
}

}  // namespace prostm::app
