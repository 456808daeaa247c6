#pragma once
/// Text of hand recordings: whole documents, or one JSON value per line. Private to io.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// Removes the next non-blank line from `text` and returns it; empty at the end. `line` is its
/// number, from 1.
std::string_view next_line(std::string_view& text, std::size_t& line);

/// Whether the text begins like JSON, with an object or a list.
bool is_json_or_lines(std::string_view text);

/// Whether the text has one JSON value per line: at least one of the first two lines is a complete
/// value.
bool has_value_a_line(std::string_view text);

/// Throws an InputError. @param what clause about the file `name`: "is a PNG picture, not a hand
/// recording".
[[noreturn]] void refuse_as_hands(const std::string& name, const std::string& what);

}  // namespace prostm
