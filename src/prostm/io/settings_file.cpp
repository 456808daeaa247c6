#include "prostm/io/settings_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "prostm/core/file/file.hpp"
#include "prostm/core/file/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm {
namespace {

std::vector<std::string> names_of(const SettingsGroup& group) {
  std::vector<std::string> names;
  for (const SettingRow& row : setting_rows(group.read)) names.emplace_back(row.setting.name);
  return names;
}

bool is_among(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Sets the fields given in a table.
class TomlReader : public SettingsWriter {
 public:
  TomlReader(const toml::table& table, const std::string& file, const std::string& group)
      : table_(table), file_(file), group_(group) {}

  void field(const Setting& s, double& value) override {
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return;
    if (!node->is_number()) fail(s.name, *node, "must be a number");
    const double x = *node->value<double>();
    if (!std::isfinite(x)) fail(s.name, *node, "must be finite");
    check_bounds(s, *node, x);
    value = x;
  }
  void field(const Setting& s, int& value) override {
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return;
    if (!node->is_integer()) fail(s.name, *node, "must be a whole number");
    const std::int64_t x = node->as_integer()->get();
    if (x < std::numeric_limits<int>::min() || x > std::numeric_limits<int>::max()) {
      fail(s.name, *node, "must fit into 32 bits");
    }
    check_bounds(s, *node, static_cast<int>(x));
    value = static_cast<int>(x);
  }
  void field(const Setting& s, bool& value) override {
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return;
    if (!node->is_boolean()) fail(s.name, *node, "must be true or false");
    value = node->as_boolean()->get();
  }
  void field(const Setting& s, std::string& value) override {
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return;
    if (!node->is_string()) fail(s.name, *node, "must be a string in quotes");
    value = node->as_string()->get();
  }

  void choice(const Setting& s, std::span<const std::string_view> names, int& index) override {
    std::string name(names[static_cast<std::size_t>(index)]);
    field(s, name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) fail(s.name, *table_.get(s.name), must_be(name, names).c_str());
    index = static_cast<int>(found - names.begin());
  }
  bool replaced(const Setting& s) override {
    replaced_names.emplace_back(s.name);
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return false;
    double value = node->is_boolean() && node->as_boolean()->get() ? 1.0 : 0.0;
    if (!node->is_boolean()) field(s, value);
    if (value == 0.0) return false;
    warnings.push_back(fmt::format("{}, line {}: {}", file_, node->source().begin.line,
                                   replacement_text(group_, s)));
    return true;
  }

  std::vector<std::string> replaced_names, warnings;

 private:
  [[noreturn]] void fail(const char* name, const toml::node& node, const char* bound) const {
    throw InputError(
        fmt::format("{}, line {}: {}.{} {}", file_, node.source().begin.line, group_, name, bound));
  }
  template <class Number>
  void check_bounds(const Setting& s, const toml::node& node, Number value) const {
    try {
      require_bounds(s, value);
    } catch (const std::invalid_argument& error) {
      throw InputError(
          fmt::format("{}, line {}: {}.{}", file_, node.source().begin.line, group_, error.what()));
    }
  }

  const toml::table& table_;
  const std::string& file_;
  const std::string& group_;
};

/// Writes the fields of a group.
class JsonWriter : public SettingsReader {
 public:
  explicit JsonWriter(nlohmann::ordered_json& object) : object_(object) {}
  void field(const Setting& s, const double& value) override { object_[s.name] = value; }
  void field(const Setting& s, const int& value) override { object_[s.name] = value; }
  void field(const Setting& s, const bool& value) override { object_[s.name] = value; }
  void field(const Setting& s, const std::string& value) override { object_[s.name] = value; }
  void choice(const Setting& s, std::span<const std::string_view> names, int index) override {
    object_[s.name] = names[static_cast<std::size_t>(index)];
  }

 private:
  nlohmann::ordered_json& object_;
};

toml::table parse_toml(std::string_view text, const std::string& file) {
  if (!kind_by_content(text).empty()) throw InputError(file + ": " + is_not(text, "TOML"));
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}, line {}, column {}: is not valid TOML ({:.200})", file,
                                 e.source().begin.line, e.source().begin.column, e.description()));
  }
}

void read_group(const toml::table& table, const SettingsGroup& group, const std::string& file,
                GivenSettings& given) {
  TomlReader reader(table, file, group.name);
  try {
    group.write(reader);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}.{}", file, group.name, error.what()));
  }
  const std::vector<std::string> known = names_of(group);
  for (const auto& [key, node] : table) {
    if (!is_among(known, key.str()) && !is_among(reader.replaced_names, key.str())) {
      throw InputError(fmt::format("{}, line {}: {} has no setting \"{}\"; {}", file,
                                   key.source().begin.line, group.name, shown_name(key.str()),
                                   suggestion(key.str(), known)));
    }
    given.names.push_back(group.name + "." + std::string(key.str()));
  }
  given.warnings.insert(given.warnings.end(), reader.warnings.begin(), reader.warnings.end());
}

/// Throws an InputError that no group has this name; for a setting outside its group, it names the
/// group.
[[noreturn]] void refuse_group(const toml::key& key, const toml::node& node,
                               const std::vector<SettingsGroup>& groups,
                               const std::vector<std::string>& others, const std::string& file) {
  std::vector<std::string> known = others, homes;
  for (const SettingsGroup& group : groups) {
    known.push_back(group.name);
    if (is_among(names_of(group), key.str()))
      homes.push_back(fmt::format("[{}] {}", group.name, key.str()));
  }
  const std::string where = fmt::format("{}, line {}", file, key.source().begin.line);
  if (!node.is_table() && !homes.empty()) {
    throw InputError(fmt::format("{}: \"{}\" is outside a group of settings; did you mean {}?",
                                 where, key.str(), fmt::join(homes, " or ")));
  }
  throw InputError(fmt::format("{}: there is no group of settings \"{}\"; {}", where,
                               shown_name(key.str()), suggestion(key.str(), known)));
}

}  // namespace

bool GivenSettings::has(std::string_view name) const {
  return is_among(names, name);
}

GivenSettings read_settings(const std::string& path, const std::vector<SettingsGroup>& groups) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
  return settings_from_toml(read_file(path, kMaxBytes, Empty::Allowed), path, groups);
}

GivenSettings settings_from_toml(std::string_view text, const std::string& name,
                                 const std::vector<SettingsGroup>& groups,
                                 const std::vector<std::string>& inside,
                                 const std::vector<std::string>& others) {
  GivenSettings given;
  const toml::table document = parse_toml(text, name);
  const toml::table* whole = &document;
  for (const std::string& key : inside) {
    const toml::node* node = whole->get(key);
    if (node == nullptr || !node->is_table()) return given;
    whole = node->as_table();
  }
  for (const auto& [key, node] : *whole) {
    const std::string_view typed = key.str();
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [typed](const auto& g) { return g.name == typed; });
    if (group == groups.end() && is_among(others, typed)) continue;
    if (group == groups.end()) refuse_group(key, node, groups, others, name);
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      throw InputError(fmt::format("{}, line {}: {} must be a group of settings, written [{}]",
                                   name, key.source().begin.line, group->name, group->name));
    }
    read_group(*table, *group, name, given);
  }
  return given;
}

int line_in_toml(std::string_view text, const std::string& name,
                 const std::vector<std::string>& keys) {
  const toml::table document = parse_toml(text, name);
  const toml::node* node = &document;
  for (const std::string& key : keys) {
    node = node->is_table() ? node->as_table()->get(key) : nullptr;
    if (node == nullptr) return 0;
  }
  return static_cast<int>(node->source().begin.line);
}

std::vector<std::string> tables_in_toml(std::string_view text, const std::string& name,
                                        const std::string& table) {
  const toml::table document = parse_toml(text, name);
  const toml::node* outer = document.get(table);
  if (outer == nullptr) return {};
  if (!outer->is_table()) {
    throw InputError(fmt::format("{}, line {}: {} must be tables, written [{}.NAME]", name,
                                 outer->source().begin.line, table, table));
  }
  std::vector<std::pair<toml::source_index, std::string>> found;
  for (const auto& [key, node] : *outer->as_table()) {
    if (!node.is_table()) {
      throw InputError(fmt::format("{}, line {}: {}.{} must be a table, written [{}.{}]", name,
                                   key.source().begin.line, table, shown_name(key.str()), table,
                                   shown_name(key.str())));
    }
    found.emplace_back(key.source().begin.line, key.str());
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (auto& [line, key] : found) names.push_back(std::move(key));
  return names;
}

nlohmann::ordered_json settings_to_json(const std::vector<SettingsGroup>& groups) {
  auto document = nlohmann::ordered_json::object();
  for (const SettingsGroup& group : groups) {
    nlohmann::ordered_json& object = document[group.name] = nlohmann::ordered_json::object();
    JsonWriter writer(object);
    group.read(writer);
  }
  return document;
}

}  // namespace prostm
