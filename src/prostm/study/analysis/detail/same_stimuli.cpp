#include "prostm/study/analysis/detail/same_stimuli.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm::study {
namespace {

using Json = nlohmann::ordered_json;
using Names = std::vector<std::string>;

/// "participant 3", or "participants 1, 2, 5 and 12 more".
std::string participants_text(const Names& names) {
  constexpr std::size_t kMostShown = 4;
  std::string out = names.size() == 1 ? "participant " : "participants ";
  for (std::size_t i = 0; i < std::min(names.size(), kMostShown); ++i)
    out += (i == 0 ? "" : ", ") + shown_name(names[i]);
  if (names.size() > kMostShown) out += fmt::format(" and {} more", names.size() - kMostShown);
  return out;
}

/// Participants by value of a setting.
using ByValue = std::map<std::string, Names>;

/// "\"fast\" (participants 1, 2) and \"best\" (participants 3, 4)".
std::string values_text(const ByValue& values) {
  std::string out;
  for (const auto& [value, names] : values) {
    out += fmt::format("{}{} ({})", out.empty() ? "" : " and ", shown_name(value),
                       participants_text(names));
  }
  return out;
}

/// Settings of the run that do not change a stimulus.
constexpr std::array kNotTheStimulus = {"/pipeline/threads", "/pipeline/tracker"};

/// The keys of a part of the protocols whose values differ, with these values. A missing key has
/// the value "not given".
std::map<std::string, ByValue> differences(std::span<const StudyFile> files,
                                           const Json::json_pointer& part) {
  std::vector<std::pair<const StudyFile*, std::map<std::string, std::string>>> flat;
  std::set<std::string> keys;
  for (const StudyFile& file : files) {
    if (!file.protocol.contains(part)) continue;
    auto& values = flat.emplace_back(&file, std::map<std::string, std::string>()).second;
    const Json settings = file.protocol.at(part).flatten();  // items() refers to it
    for (const auto& [key, value] : settings.items()) {
      values[key] = value.dump(-1, ' ', false, Json::error_handler_t::replace);
      keys.insert(key);
    }
  }
  std::map<std::string, ByValue> out;
  for (const std::string& key : keys) {
    ByValue by;
    for (const auto& [file, values] : flat) {
      const auto found = values.find(key);
      by[found == values.end() ? "not given" : found->second].push_back(file->participant);
    }
    if (by.size() > 1) out[key] = std::move(by);
  }
  return out;
}

/// "/plan/preset" as "plan.preset".
std::string dotted(std::string key) {
  key.erase(0, key.starts_with('/') ? 1 : 0);
  std::replace(key.begin(), key.end(), '/', '.');
  return key;
}

/// Describes the first differences, and the number of others.
std::string text_of(const std::map<std::string, ByValue>& found, const std::string& prefix) {
  constexpr std::size_t kMostShown = 3;
  std::string out;
  std::size_t shown = 0;
  for (const auto& [key, values] : found) {
    if (++shown > kMostShown) break;
    out += fmt::format("{}{}{} is {}", out.empty() ? "" : "; ", prefix, dotted(key),
                       values_text(values));
  }
  if (found.size() > kMostShown)
    out += fmt::format("; and {} more differ", found.size() - kMostShown);
  return out;
}

/// The names of methods in any of the protocols.
std::set<std::string> methods_of(std::span<const StudyFile> files) {
  std::set<std::string> out;
  for (const StudyFile& file : files) {
    if (!file.protocol.contains("method")) continue;
    for (const auto& [name, settings] : file.protocol["method"].items()) out.insert(name);
  }
  return out;
}

/// Describes differences between the stimuli of files; empty if they agree.
std::string stimuli_of_files(std::span<const StudyFile> files) {
  std::string out;
  const auto add = [&](std::map<std::string, ByValue> found, const std::string& prefix) {
    for (const char* key : kNotTheStimulus) found.erase(key);
    if (!found.empty()) out += (out.empty() ? "" : "; ") + text_of(found, prefix);
  };
  for (const std::string& method : methods_of(files))
    add(differences(files, Json::json_pointer() / "method" / method), "method." + method + ".");
  std::map<std::string, ByValue> level;
  for (auto& [key, values] : differences(files, Json::json_pointer("/level"))) {
    if (key == "/setting" || key == "/reference" || key == "/against") level[key] = values;
  }
  add(level, "level.");
  std::map<std::string, ByValue> made_up;
  for (const StudyFile& file : files)
    made_up["/rehearsal"][file.rehearsal ? "true" : "false"].push_back(file.participant);
  if (made_up["/rehearsal"].size() > 1) add(made_up, "");
  return out;
}

/// Describes differences between the checksums in tables, whose settings are unknown.
std::string stimuli_of_answers(std::span<const Answer> answers) {
  std::map<std::tuple<std::string, std::string, std::optional<double>>,
           std::map<std::string, std::set<std::string>>>
      checksums;
  for (const Answer& a : answers) {
    if (!a.stimulus.empty())
      checksums[{a.method, a.scene, a.level}][a.stimulus].insert(a.participant);
  }
  for (const auto& [of, values] : checksums) {
    if (values.size() < 2) continue;
    ByValue by;
    for (const auto& [checksum, names] : values) by[checksum] = Names(names.begin(), names.end());
    return fmt::format("the checksum of method {} in scene {} is {}", shown_name(std::get<0>(of)),
                       shown_name(std::get<1>(of)), values_text(by));
  }
  return {};
}

/// Notes differences between runs that do not change the stimulus.
void note_runs(std::span<const Answer> answers, std::vector<std::string>& notes) {
  using Fact = std::pair<const char*, std::string RunFacts::*>;
  for (const auto& [name, member] :
       {Fact{"device", &RunFacts::device}, Fact{"array", &RunFacts::array},
        Fact{"hand", &RunFacts::hand}, Fact{"version of prostm", &RunFacts::version}}) {
    std::map<std::string, std::set<std::string>> found;
    for (const Answer& a : answers) {
      if (!(a.run.*member).empty()) found[a.run.*member].insert(a.participant);
    }
    if (found.size() < 2) continue;
    ByValue by;
    for (const auto& [value, names] : found) by[value] = Names(names.begin(), names.end());
    notes.push_back(fmt::format("The {} differs: {}.", name, values_text(by)));
  }
}

void note_protocols(std::span<const StudyFile> files, std::vector<std::string>& notes) {
  std::map<std::string, ByValue> found = differences(files, Json::json_pointer());
  std::erase_if(found, [](const auto& of) {
    return of.first.starts_with("/method/") || of.first.starts_with("/study/participants");
  });
  if (!found.empty()) notes.push_back("Protocols differ: " + text_of(found, "") + '.');
}

}  // namespace

void require_same_stimuli(std::span<const Answer> answers, std::span<const StudyFile> files,
                          bool pool, std::vector<std::string>& notes) {
  std::set<std::string> with_settings;
  for (const StudyFile& file : files) {
    if (file.protocol.contains("method")) with_settings.insert(file.participant);
  }
  const bool all_have_settings = std::all_of(answers.begin(), answers.end(), [&](const Answer& a) {
    return with_settings.contains(a.participant);
  });
  std::string found = stimuli_of_files(files);
  if (found.empty() && !all_have_settings) found = stimuli_of_answers(answers);
  if (!found.empty() && !pool) {
    throw InputError("the same name stands for different stimuli: " + found +
                     "; analyse each study separately, or add --pool to combine them");
  }
  if (!found.empty())
    notes.push_back("Answers to different stimuli are combined (--pool): " + found + '.');
  note_protocols(files, notes);
  note_runs(answers, notes);
}

}  // namespace prostm::study
