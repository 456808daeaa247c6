#include "prostm/study/plan/study_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"
#include "prostm/study/plan/sha256.hpp"
#include "prostm/study/task/protocol_file.hpp"
#include "prostm/study/task/task.hpp"

namespace prostm {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kCheck = ",\"check\":\"";
constexpr std::size_t kDigits = 16;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

std::optional<double> number_or_null(const Json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

/// Appends a line with its check.
void add_line(std::string& text, const Json& line) {
  std::string body = line.dump(-1, ' ', false, Json::error_handler_t::replace);
  body.pop_back();  // the closing brace
  const std::string check = sha256(text + body).substr(0, kDigits);
  text += body + std::string(kCheck) + check + "\"}\n";
}

/// Reads the lines, and checks each.
std::vector<Json> lines_of(std::string_view text, const std::string& file) {
  std::vector<Json> out;
  for (std::size_t at = 0; at < text.size();) {
    const std::string where = fmt::format("{}, line {}", file, out.size() + 1);
    const std::size_t end = text.find('\n', at);
    const std::size_t tail = kCheck.size() + kDigits + 2;  // a quote and a brace
    const std::size_t size = (end == std::string_view::npos ? text.size() : end) - at;
    const std::string_view line = text.substr(at, size);
    if (end == std::string_view::npos || size <= tail ||
        line.substr(size - tail, kCheck.size()) != kCheck)
      throw InputError(where + " does not end with its check, so the plan was changed or cut off");
    if (line.substr(size - kDigits - 2, kDigits) !=
        sha256(text.substr(0, at + size - tail)).substr(0, kDigits)) {
      throw InputError(where +
                       " does not match its check, so it was changed, or a line before it was "
                       "removed; put the plan back as it was written");
    }
    Json& json = out.emplace_back(Json::parse(line, nullptr, false));
    if (!json.is_object()) throw InputError(where + " is not a JSON object");
    at = end + 1;
  }
  return out;
}

Json settings_line(const StudyPlan& plan) {
  return {{"kind", "settings"},
          {"participants", plan.participants},
          {"measure", name_of(plan.measure)},
          {"test", name_of(plan.test)},
          {"alpha", plan.alpha},
          {"chance", plan.chance},
          {"correction", name_of(plan.correction)},
          {"equivalence", or_null(plan.equivalence)}};
}

Json exclusions_line(const Exclusions& of) {
  return {{"kind", "exclusions"},
          {"incomplete", of.incomplete},
          {"overridden_gate", of.overridden_gate},
          {"failed_practice", of.failed_practice},
          {"wrong_checks_above", or_null(of.wrong_checks_above)},
          {"response_below_s", or_null(of.response_below)},
          {"response_above_s", or_null(of.response_above)}};
}

void read_settings(const Json& line, StudyPlan& plan) {
  plan.participants = line.at("participants");
  plan.measure = from_name<Measure>(line.at("measure").get<std::string>(), "measure");
  plan.test = from_name<PlannedTest>(line.at("test").get<std::string>(), "test");
  plan.alpha = line.at("alpha");
  plan.chance = line.at("chance");
  plan.correction = from_name<Correction>(line.at("correction").get<std::string>(), "correction");
  plan.equivalence = number_or_null(line.at("equivalence"));
}

void read_line(const Json& line, StudyPlan& plan) {
  const std::string kind = line.value("kind", "");
  if (kind == "protocol") {
    plan.protocols.push_back({line.at("file"), line.at("protocol")});
  } else if (kind == "settings") {
    read_settings(line, plan);
  } else if (kind == "exclusions") {
    plan.exclusions = {line.at("incomplete"),
                       line.at("overridden_gate"),
                       line.value("failed_practice", false),
                       number_or_null(line.value("wrong_checks_above", Json(nullptr))),
                       number_or_null(line.at("response_below_s")),
                       number_or_null(line.at("response_above_s"))};
  } else if (kind == "note") {
    plan.notes.push_back(line.at("text"));
  } else if (kind == "comparison") {
    const auto name = [&](const char* key) {
      return line.at(key).is_null() ? std::string() : line.at(key).get<std::string>();
    };
    plan.comparisons.push_back({name("scene"), name("first"), name("second")});
  } else {
    throw InputError("the kind " + shown_name(kind) + " is unknown");
  }
}

/// Settings of a protocol by their path, without those that do not change a stimulus.
std::map<std::string, std::string> flat(const Json& protocol) {
  std::map<std::string, std::string> out;
  const Json settings = protocol.flatten();
  for (const auto& [key, value] : settings.items()) {
    if (key.ends_with("/pipeline/threads") || key.ends_with("/pipeline/tracker") ||
        key.ends_with("/simulated_array/realtime"))
      continue;
    std::string name = key.substr(1);
    std::replace(name.begin(), name.end(), '/', '.');
    out[name] = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return out;
}

/// Describes the settings that differ; empty if all agree.
std::vector<std::string> differences(const Json& found, const Json& planned) {
  const auto a = flat(found), b = flat(planned);
  std::vector<std::string> out;
  const auto value = [](const auto& of, const std::string& key) {
    const auto at = of.find(key);
    return at == of.end() ? std::string("not given") : shown_name(at->second);
  };
  std::map<std::string, std::string> all = a;
  all.insert(b.begin(), b.end());
  for (const auto& [key, ignored] : all) {
    if (value(a, key) == value(b, key)) continue;
    out.push_back(fmt::format("{} is {}, and {} in the plan", key, value(a, key), value(b, key)));
  }
  return out;
}

Measure measure_of(const Protocol& protocol) {
  const Task& task = *protocol.trials.task;
  if (task.is_tuned()) return Measure::Level;
  return task.traits().has_levels ? Measure::Threshold : Measure::Right;
}

}  // namespace

void complete_plan(StudyPlan& plan, std::span<const Protocol> protocols, bool each_scene) {
  const Protocol& first = protocols.front();
  plan.measure = measure_of(first);
  plan.participants = 0;
  for (const Protocol& protocol : protocols) {
    const auto is_same = [](const auto& a, const auto& b) { return a.name == b.name; };
    if (measure_of(protocol) != plan.measure ||
        !std::equal(first.methods.begin(), first.methods.end(), protocol.methods.begin(),
                    protocol.methods.end(), is_same) ||
        !std::equal(first.scenes.begin(), first.scenes.end(), protocol.scenes.begin(),
                    protocol.scenes.end(), is_same)) {
      throw InputError(
          "the protocols have different tasks, methods or scenes; write a plan for each");
    }
    plan.participants += protocol.study.participants;
  }
  std::vector<std::string> scenes;
  if (plan.measure == Measure::Right) scenes.emplace_back();  // other measures have one per scene
  const bool is_one = first.scenes.size() == 1;
  for (const StudyScene& scene : first.scenes) {
    if ((each_scene && !is_one) || plan.measure != Measure::Right) scenes.push_back(scene.name);
  }
  const auto& methods = first.methods;
  if (methods.size() == 1 && plan.measure != Measure::Right)
    throw InputError(
        "there is one method, and its answers are not right or wrong: nothing to test");
  for (const std::string& scene : scenes) {
    if (methods.size() == 1) plan.comparisons.push_back({scene, methods.front().name, ""});
    for (std::size_t b = 1; b < methods.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a)
        plan.comparisons.push_back({scene, methods[a].name, methods[b].name});
    }
  }
}

std::string plan_text(const StudyPlan& plan) {
  std::string text;
  add_line(text, {{"format", kStudyPlanFormat}, {"created_utc", plan.created_utc}});
  for (const PlannedProtocol& of : plan.protocols) {
    add_line(text, {{"kind", "protocol"},
                    {"file", of.file},
                    {"sha256", sha256(of.protocol.dump())},
                    {"protocol", of.protocol}});
  }
  add_line(text, settings_line(plan));
  add_line(text, exclusions_line(plan.exclusions));
  for (const std::string& note : plan.notes) add_line(text, {{"kind", "note"}, {"text", note}});
  for (const PlannedComparison& of : plan.comparisons) {
    Json line = {
        {"kind", "comparison"}, {"scene", nullptr}, {"first", of.first}, {"second", nullptr}};
    if (!of.scene.empty()) line["scene"] = of.scene;
    if (!of.second.empty()) line["second"] = of.second;
    add_line(text, line);
  }
  add_line(text, {{"kind", "end"}, {"sha256", sha256(text)}});
  return text;
}

StudyPlan plan_from_text(std::string_view text, const std::string& file) {
  if (text.find(kStudyPlanFormat) == std::string_view::npos)
    throw InputError(file + " is not a plan of prostm study preregister");
  const std::vector<Json> lines = lines_of(text, file);
  StudyPlan plan;
  std::size_t at = 0;
  try {
    plan.created_utc = lines.at(0).at("created_utc");
    for (at = 1; at + 1 < lines.size(); ++at) read_line(lines[at], plan);
    if (lines.back().value("kind", "") != "end")
      throw InputError("the last line is not its end, so the plan was cut off");
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}, line {}: {}", file, at + 1, error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}, line {}: {}", file, at + 1, error.what()));
  }
  plan.sha256 = sha256(text);
  return plan;
}

void require_planned(const nlohmann::ordered_json& protocol, const std::string& where,
                     const StudyPlan& plan, const std::string& plan_file) {
  std::vector<std::string> least;  // from the most similar protocol
  std::size_t line = 0;
  for (std::size_t i = 0; i < plan.protocols.size(); ++i) {
    std::vector<std::string> found = differences(protocol, plan.protocols[i].protocol);
    if (found.empty()) return;
    if (line == 0 || found.size() < least.size()) least = std::move(found), line = i + 2;
  }
  constexpr std::size_t kMostShown = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(least.size(), kMostShown); ++i)
    text += (i == 0 ? "" : "; ") + least[i];
  if (least.size() > kMostShown) text += fmt::format("; and {} more", least.size() - kMostShown);
  throw InputError(
      fmt::format("{} has another protocol than {}, line {}: {}", where, plan_file, line, text));
}

}  // namespace prostm
