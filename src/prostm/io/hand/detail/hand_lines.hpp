#pragma once
/// Text of hand recordings: whole documents, or one JSON value a line. Private to io.

#include <cstddef>
#include <string>
#include <string_view>

namespace prostm {

/// The next line that is not blank, cut from `text`; empty at the end. `line` counts from 1.
std::string_view next_line(std::string_view& text, std::size_t& line);

/// Whether the text begins as JSON does, with an object or a list.
bool is_json_or_lines(std::string_view text);

/// Whether the text has one JSON value a line: of the first two lines one is whole.
bool has_value_a_line(std::string_view text);

/// @param what the file `name` is: "is a PNG picture, not a hand recording". @throws InputError.
[[noreturn]] void refuse_as_hands(const std::string& name, const std::string& what);

}  // namespace prostm
