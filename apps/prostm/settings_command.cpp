#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm::app {
namespace {

/// A setting in its group, with its default as a settings file has it.
struct ListedSetting {
  std::string group;
  SettingRow row;
  std::string by_default;

  std::string name() const { return row.setting.name; }
  bool changed() const { return row.value != by_default; }
};

std::vector<ListedSetting> list_of(const PipelineSettings& settings) {
  const PipelineSettings defaults;
  const auto groups = settings_groups(settings), groups_by_default = settings_groups(defaults);
  std::vector<ListedSetting> all;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto rows = setting_rows(groups[g].read),
               by_default = setting_rows(groups_by_default[g].read);
    for (std::size_t i = 0; i < rows.size(); ++i)
      all.push_back({groups[g].name, rows[i], by_default[i].value});
  }
  return all;
}

/// @throws InputError always: no setting has this name; suggests the most similar one.
[[noreturn]] void refuse(const std::vector<ListedSetting>& all, const std::string& name) {
  const std::size_t dot = name.find('.');
  const std::string group = name.substr(0, dot);
  std::vector<std::string> groups, keys;
  for (const ListedSetting& s : all) {
    if (groups.empty() || groups.back() != s.group) groups.push_back(s.group);
    if (dot == name.npos || s.group == group) keys.push_back(s.name());
  }
  if (dot != name.npos && !keys.empty()) {
    const std::string key = name.substr(dot + 1);
    throw InputError(
        fmt::format("{} has no setting \"{}\"; {}", group, shown_name(key), suggestion(key, keys)));
  }
  if (dot != name.npos) {
    throw InputError(fmt::format("there is no group of settings \"{}\"; {}", shown_name(group),
                                 suggestion(group, groups)));
  }
  keys.insert(keys.begin(), groups.begin(), groups.end());
  const auto nearest = nearest_name(name, keys);
  throw InputError(
      fmt::format("there is no setting or group of settings \"{}\"; {}", shown_name(name),
                  nearest ? fmt::format("did you mean \"{}\"?", *nearest)
                          : fmt::format("the groups are {}", fmt::join(groups, ", "))));
}

/// Returns the settings of a group, or those with a key, or GROUP.KEY.
std::vector<ListedSetting> chosen(std::vector<ListedSetting> all, const std::string& name) {
  if (name.empty()) return all;
  std::vector<ListedSetting> some;
  std::ranges::copy_if(all, std::back_inserter(some), [&](const ListedSetting& s) {
    return name == s.group || name == s.name() || name == s.group + "." + s.name();
  });
  if (some.empty()) refuse(all, name);
  return some;
}

/// Characters of a text, each of which is one column wide.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

/// A text in lines of at most `width` characters, broken between words.
std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
  std::vector<std::string> lines(1);
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    std::string& line = lines.back();
    if (line.empty()) {
      line = word;
    } else if (width_of(line) + 1 + width_of(word) <= width) {
      line += " " + std::string(word);
    } else {
      lines.emplace_back(word);
    }
  }
  return lines;
}

/// Widths of the columns [characters]: as narrow as their texts allow.
struct Columns {
  static constexpr std::size_t kPage = 118, kWidestRange = 26;
  std::size_t key = 3, value = 7, range = 5;

  explicit Columns(const std::vector<ListedSetting>& settings) {
    for (const ListedSetting& s : settings) {
      key = std::max(key, width_of(s.name()));
      value = std::max(value, width_of(s.row.value));
      for (const std::string& line : wrapped(s.row.bounds, kWidestRange))
        range = std::max(range, width_of(line));
    }
  }
  std::size_t meaning() const { return kPage - key - value - range - 8; }
};

void print_row(std::FILE* out, const Columns& columns, const ListedSetting& s) {
  const std::string meaning = s.changed()
                                  ? fmt::format("{} (default {})", s.row.setting.help, s.by_default)
                                  : s.row.setting.help;
  const auto ranges = wrapped(s.row.bounds, columns.range),
             meanings = wrapped(meaning, columns.meaning());
  for (std::size_t i = 0; i < std::max(ranges.size(), meanings.size()); ++i) {
    const std::string range = i < ranges.size() ? ranges[i] : "";
    const std::string line =
        fmt::format("  {:<{}}  {:<{}}  {:<{}}  {}", i == 0 ? s.name() : "", columns.key,
                    i == 0 ? s.row.value : "", columns.value, range, columns.range,
                    i < meanings.size() ? meanings[i] : "");
    fmt::print(out, "{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
  }
}

void print_table(std::FILE* out, const std::vector<ListedSetting>& settings) {
  const Columns columns(settings);
  const bool any_changed = std::ranges::any_of(settings, &ListedSetting::changed);
  fmt::print(out, "  {:<{}}  {:<{}}  {:<{}}  meaning\n", "key", columns.key,
             any_changed ? "value" : "default", columns.value, "range", columns.range);
  std::string group;
  for (const ListedSetting& s : settings) {
    if (s.group != group) fmt::print(out, "\n[{}]\n", s.group);
    group = s.group;
    print_row(out, columns, s);
  }
}

/// A settings file in which everything that has its default is commented out.
void print_toml(const std::vector<ListedSetting>& settings) {
  fmt::print("# Settings of prostm {}. A key takes effect once the # before it is removed.\n",
             version_text());
  std::string group;
  for (const ListedSetting& s : settings) {
    if (s.group != group) fmt::print("\n[{}]\n", s.group);
    group = s.group;
    fmt::print("# {}{}{}\n{}{} = {}\n", s.row.setting.help, s.row.bounds.empty() ? "" : "; ",
               s.row.bounds, s.changed() ? "" : "#", s.name(), s.row.value);
  }
}

nlohmann::ordered_json bound_json(const SettingRow& row, double bound) {
  if (!std::isfinite(bound)) return nullptr;
  if (row.type == std::string("integer")) return static_cast<std::int64_t>(bound);
  return bound;
}

nlohmann::ordered_json list_json(const std::vector<ListedSetting>& settings,
                                 const PipelineSettings& in_force) {
  const PipelineSettings defaults;
  const nlohmann::ordered_json values = settings_to_json(settings_groups(in_force)),
                               by_default = settings_to_json(settings_groups(defaults));
  auto rows = nlohmann::ordered_json::array();
  for (const ListedSetting& s : settings) {
    const Setting& setting = s.row.setting;
    const bool is_choice = !s.row.choices.empty();
    rows.push_back({{"group", s.group},
                    {"name", setting.name},
                    {"type", s.row.type},
                    {"value", values[s.group][setting.name]},
                    {"default", by_default[s.group][setting.name]},
                    {"unit", setting.unit},
                    {"least", bound_json(s.row, setting.least)},
                    {"most", bound_json(s.row, setting.most)},
                    {"choices", is_choice ? nlohmann::ordered_json(s.row.choices)
                                          : nlohmann::ordered_json(nullptr)},
                    {"help", setting.help}});
  }
  return {{"format", "prostm-settings/1"}, {"settings", std::move(rows)}};
}

}  // namespace

int settings_command(const SettingsOptionsGiven& given) {
  const PipelineSettings settings = make_settings(given.common, std::nullopt);
  const std::vector<ListedSetting> list = chosen(list_of(settings), given.name);
  if (given.toml) {
    print_toml(list);
    return 0;
  }
  std::FILE* out = prose(given.common.json);
  print_table(out, list);
  if (given.common.json.empty()) return 0;
  write_json(given.common.json, list_json(list, settings));
  say_written(out, given.common.json);
  return 0;
}

}  // namespace prostm::app
