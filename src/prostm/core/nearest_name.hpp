#pragma once
/// Suggestions for unknown names.

#include <string>
#include <string_view>
#include <vector>

namespace prostm {

/// Shortens a name from a file for a message.
std::string shown_name(std::string_view name);

/// Returns "did you mean …", or all known names if no name is near.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace prostm
