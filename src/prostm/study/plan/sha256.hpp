#pragma once
/// SHA-256 (FIPS 180-4).

#include <string>
#include <string_view>

namespace prostm {

/// Returns the hash of a text as 64 hexadecimal digits.
std::string sha256(std::string_view text);

}  // namespace prostm
