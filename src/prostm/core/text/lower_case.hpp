#pragma once
/// Comparing names whose letters may be of either case.

#include <string>
#include <string_view>

namespace prostm {

/// The text with A to Z as a to z; every other byte stays, so UTF-8 does too.
std::string lower_case(std::string_view text);

}  // namespace prostm
