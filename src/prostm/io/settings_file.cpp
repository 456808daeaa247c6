#include "prostm/io/settings_file.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "prostm/core/file.hpp"
#include "prostm/core/file_kind.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/core/nearest_name.hpp"

namespace prostm {
namespace {

/// Lists the names of a group's fields.
class NameCollector : public SettingsReader {
 public:
  void field(const Setting& s, const double&) override { names.emplace_back(s.name); }
  void field(const Setting& s, const int&) override { names.emplace_back(s.name); }
  void field(const Setting& s, const bool&) override { names.emplace_back(s.name); }
  void field(const Setting& s, const std::string&) override { names.emplace_back(s.name); }
  void choice(const Setting& s, std::span<const std::string_view>, int) override {
    names.emplace_back(s.name);
  }
  std::vector<std::string> names;
};

/// Sets the fields that a table gives.
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
    value = x;
  }
  void field(const Setting& s, int& value) override {
    const toml::node* node = table_.get(s.name);
    if (node == nullptr) return;
    if (!node->is_integer()) fail(s.name, *node, "must be a whole number");
    const std::int64_t x = node->as_integer()->get();
    if (x < std::numeric_limits<int>::min() || x > std::numeric_limits<int>::max()) {
      fail(s.name, *node, "must lie within 32 bits");
    }
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

 private:
  [[noreturn]] void fail(const char* name, const toml::node& node, const char* bound) const {
    throw InputError(
        fmt::format("{}, line {}: {}.{} {}", file_, node.source().begin.line, group_, name, bound));
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
                std::vector<std::string>& given) {
  NameCollector known;
  group.read(known);
  for (const auto& [key, node] : table) {
    if (std::find(known.names.begin(), known.names.end(), key.str()) == known.names.end()) {
      throw InputError(fmt::format("{}, line {}: {} has no setting \"{}\"; {}", file,
                                   key.source().begin.line, group.name, shown_name(key.str()),
                                   suggestion(key.str(), known.names)));
    }
    given.push_back(group.name + "." + std::string(key.str()));
  }
  TomlReader reader(table, file, group.name);
  group.write(reader);
}

}  // namespace

std::vector<std::string> read_settings(const std::string& path,
                                       const std::vector<SettingsGroup>& groups) {
  constexpr std::size_t kMaxBytes = std::size_t{1} << 20;
  return settings_from_toml(read_file(path, kMaxBytes, Empty::Allowed), path, groups);
}

std::vector<std::string> settings_from_toml(std::string_view text, const std::string& name,
                                            const std::vector<SettingsGroup>& groups) {
  std::vector<std::string> given;
  const toml::table document = parse_toml(text, name);
  std::vector<std::string> known(groups.size());
  std::transform(groups.begin(), groups.end(), known.begin(), [](const auto& g) { return g.name; });
  for (const auto& [key, node] : document) {
    const std::string_view typed = key.str();
    const auto group = std::find_if(groups.begin(), groups.end(),
                                    [typed](const auto& g) { return g.name == typed; });
    if (group == groups.end()) {
      throw InputError(fmt::format("{}, line {}: there is no group of settings \"{}\"; {}", name,
                                   key.source().begin.line, shown_name(key.str()),
                                   suggestion(key.str(), known)));
    }
    const toml::table* table = node.as_table();
    if (table == nullptr) {
      throw InputError(fmt::format("{}, line {}: {} must be a group of settings, written [{}]",
                                   name, key.source().begin.line, group->name, group->name));
    }
    read_group(*table, *group, name, given);
  }
  return given;
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
