#pragma once
/// Messages about an unknown name: the known name that may have been meant.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace prostm {

/// Shortens a name from a file for a message.
std::string shown_name(std::string_view name);

/// The only known name that begins with `unknown`, or otherwise the most similar one; nothing if
/// all differ too much.
std::optional<std::string> nearest_name(std::string_view unknown,
                                        const std::vector<std::string>& known);

/// '; did you mean "…"?', the end of a sentence; empty if no known name is similar.
std::string did_you_mean(std::string_view unknown, const std::vector<std::string>& known);

/// "did you mean …", or all known names if none is similar.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& known);

}  // namespace prostm
