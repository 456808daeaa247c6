#pragma once
/// Reads settings of all stages from TOML and writes them as JSON, using only their visit().

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/settings.hpp"

namespace prostm {

/// Settings read from a file.
struct GivenSettings {
  std::vector<std::string> names;     ///< of its settings, e.g. "plan.sigma"
  std::vector<std::string> warnings;  ///< a sentence for each that has been replaced

  bool has(std::string_view name) const;
};

/// Sets the values in the file and leaves the others unchanged. @throws InputError naming file,
/// line and key: an unknown group or key (with the nearest known one), a value of the wrong type, a
/// name that is not one of the choices, a number that is not finite or out of bounds.
GivenSettings read_settings(const std::string& path, const std::vector<SettingsGroup>& groups);
/// The same from text. @param inside table that contains the groups, e.g. {"method", "am"}; empty:
/// the document. @param others other tables, which are read elsewhere.
GivenSettings settings_from_toml(std::string_view text, const std::string& name,
                                 const std::vector<SettingsGroup>& groups,
                                 const std::vector<std::string>& inside = {},
                                 const std::vector<std::string>& others = {});

/// Returns the line of a key or table of the document, e.g. {"method", "am", "plan"}; 0 if it is
/// missing. @throws InputError: not TOML.
int line_in_toml(std::string_view text, const std::string& name,
                 const std::vector<std::string>& keys);

/// Returns the names of the tables inside a table of the document, in the order of their lines;
/// empty if it is missing. @throws InputError: it, or one of its members, is not a table.
std::vector<std::string> tables_in_toml(std::string_view text, const std::string& name,
                                        const std::string& table);

/// Returns {"plan": {"paths": 4, …}, …}.
nlohmann::ordered_json settings_to_json(const std::vector<SettingsGroup>& groups);

}  // namespace prostm
