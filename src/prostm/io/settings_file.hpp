#pragma once
/// Settings of every stage as TOML in, JSON out, through their visit() alone.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "prostm/core/settings.hpp"

namespace prostm {

/// Sets what the file gives and leaves the rest. @throws InputError that names file, line and key:
/// unknown group or key (with the nearest known one), a value of the wrong type, a name that
/// the choice lacks, a number that is not finite or out of its bounds. @return the names of what it
/// gives, "plan.sigma".
std::vector<std::string> read_settings(const std::string& path,
                                       const std::vector<SettingsGroup>& groups);
/// @param inside the table that holds the groups, {"method", "am"}; empty: the document.
/// @param others tables beside the groups that are read elsewhere.
std::vector<std::string> settings_from_toml(std::string_view text, const std::string& name,
                                            const std::vector<SettingsGroup>& groups,
                                            const std::vector<std::string>& inside = {},
                                            const std::vector<std::string>& others = {});

/// Returns the line of a key or table of the document, {"method", "am", "plan"}; 0 where it is
/// missing. @throws InputError: no TOML.
int line_in_toml(std::string_view text, const std::string& name,
                 const std::vector<std::string>& keys);

/// Returns the names of the tables inside a table of the document, in the order of their lines;
/// none where it is missing. @throws InputError: it, or something in it, is no table.
std::vector<std::string> tables_in_toml(std::string_view text, const std::string& name,
                                        const std::string& table);

/// {"plan": {"paths": 4, …}, …}
nlohmann::ordered_json settings_to_json(const std::vector<SettingsGroup>& groups);

}  // namespace prostm
