#pragma once
/// Settings of every stage as TOML in, JSON out, through SettingsVisitor.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/settings.hpp"

namespace prostm {

/// A stage's settings under its name in files, e.g. {"plan", [&](auto& v) { plan_settings.visit(v);
/// }}.
struct SettingsGroup {
  std::string name;
  std::function<void(SettingsVisitor&)> visit;
};

/// Sets what the file gives and leaves the rest. @throws InputError that names file, line and key:
/// unknown group or key (with the nearest known one), a value of the wrong type, a number that is
/// not finite. @return the names of what it gives, "plan.sigma".
std::vector<std::string> read_settings(const std::string& path,
                                       const std::vector<SettingsGroup>& groups);
std::vector<std::string> settings_from_toml(std::string_view text, const std::string& name,
                                            const std::vector<SettingsGroup>& groups);

/// {"plan": {"paths": 4, …}, …}
std::string settings_to_json(const std::vector<SettingsGroup>& groups);

}  // namespace prostm
