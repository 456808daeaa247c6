#pragma once
/// Conversion to lower case, for case-insensitive comparison of names.

#include <string>
#include <string_view>

namespace prostm {

/// The text with A to Z as a to z; other bytes, including UTF-8 sequences, are unchanged.
std::string lower_case(std::string_view text);

}  // namespace prostm
