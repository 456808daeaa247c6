#include "prostm/viewer/detail/settings_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace prostm::viewer {
namespace {

/// Names and TOML values of a group's fields.
class TomlValues final : public SettingsReader {
 public:
  void field(const Setting& s, const double& value) override { add(s, fmt::format("{}", value)); }
  void field(const Setting& s, const int& value) override { add(s, fmt::format("{}", value)); }
  void field(const Setting& s, const bool& value) override { add(s, value ? "true" : "false"); }
  void field(const Setting& s, const std::string& value) override { add(s, quoted(value)); }
  void choice(const Setting& s, std::span<const std::string_view> names, int index) override {
    add(s, quoted(std::string(names[static_cast<std::size_t>(index)])));
  }
  std::vector<std::pair<std::string, std::string>> values;

 private:
  /// Quotes as JSON: its escapes are valid in TOML.
  static std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  }
  void add(const Setting& s, std::string value) { values.emplace_back(s.name, std::move(value)); }
};

}  // namespace

std::string changed_settings(PipelineSettings settings) {
  if (settings.plan.budget == settings.plan.traits().live_budget) settings.plan.budget = 0.0;
  const PipelineSettings defaults;
  const auto groups = settings_groups(std::as_const(settings)),
             untouched = settings_groups(defaults);
  std::string text;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    TomlValues now, before;
    groups[g].read(now);
    untouched[g].read(before);
    std::string changed;
    for (std::size_t i = 0; i < now.values.size(); ++i) {
      if (now.values[i] == before.values[i]) continue;
      changed += fmt::format("{} = {}\n", now.values[i].first, now.values[i].second);
    }
    if (!changed.empty())
      text += fmt::format("{}[{}]\n{}", text.empty() ? "" : "\n", groups[g].name, changed);
  }
  return text;
}

}  // namespace prostm::viewer
